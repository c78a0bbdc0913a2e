// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/model/scene.hpp"

namespace roomscribe {

// What puts a whole map in doubt: every component becomes doubtful, with the rival reading and a
// confidence of at most a half, and so do its points.

/// Where no room shows. A room is known by a wall and by a floor or a ceiling that meets it. Where
/// either is missing, level ground outdoors and a wall seen as a floor look the same, and what
/// stands on it is furniture only if it is a floor. A room without any of the three is dropped.
void doubt_open_places(Scene& scene, PointLabels& labels);

/// Where noise hides what stands before what: if the points of floors, ceilings and walls scatter
/// so far about their planes that a bookcase and the wall behind it would be one. Such planes lean,
/// and what is found among their points may be nothing. Asks for measure_support() before.
void doubt_blurred_places(Scene& scene, PointLabels& labels);

}  // namespace roomscribe
