// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// Puts in doubt what was found where no room shows. A room is known by a wall and by a floor or a
/// ceiling that meets it. Where either is missing, level ground outdoors and a wall seen as a floor
/// look the same, and what stands on it is furniture only if it is a floor: every component becomes
/// doubtful, with the rival reading and a confidence of at most a half, and so do its points. A
/// room without any of the three is dropped.
void doubt_open_places(Scene& scene, PointLabels& labels);

}  // namespace roomscribe
