// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// Angles in radians.
struct AxesError {
    double up = 0.0;          ///< between the up axes, in [0, pi]
    double horizontal = 0.0;  ///< between the horizontal axes, modulo a quarter turn, in [0, pi/4]
};

/// Compares the axes of two room frames, given as map -> room in one map frame. The horizontal
/// error is that of the predicted x axis (y, where x stands nearer to upright) seen from above in
/// the true room frame: x and y are interchangeable.
AxesError compare_axes(const Transform& true_room_from_map,
                       const Transform& predicted_room_from_map);

}  // namespace roomscribe
