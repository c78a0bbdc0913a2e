// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/model/label.hpp"

namespace roomscribe::test {

/// A room of 5 x 4 x 2.7 m with its floor at z = 0 and a corner at the origin, a table, a cupboard
/// before a wall and odds and ends on the floor and the table, sampled at random with noise.
struct SampledRoom {
    PointCloud cloud;
    std::vector<Label> labels;  ///< floor, ceiling, wall; unknown for all that stands in the room
};
SampledRoom sample_room(double points_per_square_metre, double noise, std::uint64_t seed);

}  // namespace roomscribe::test
