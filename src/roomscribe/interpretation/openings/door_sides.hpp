// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/interpretation/openings/wall_openings.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// A point beside an edge of a door.
struct EdgePoint {
    float outward = 0.0F;  ///< m out of the hole
    float depth = 0.0F;    ///< m behind the wall's face
};

/// Where one side of a door's frame begins and ends.
struct DoorSide {
    double inner = 0.0;           ///< m outward from where the hole's edge was taken to be
    std::optional<double> outer;  ///< m outward, too; empty for a frame in the plane of the wall
};

/// Reads a side of a door off the steps of its profile, centimetre by centimetre: the median depths
/// of wall, casing and leaf, from outside inwards. Where a door stands open, the profile ends at
/// the inner edge. Medians of many points tell steps much lower than their noise. Nothing where no
/// step stands out of the noise: a frame in the plane of its wall.
///
/// `leaf_depth`: m, of a closed leaf; empty for an open one.
std::optional<DoorSide> read_door_side(std::span<const EdgePoint> points,
                                       std::optional<double> leaf_depth, double noise);

/// Moves the edges of doors and passages to where they and their casings were seen at full density,
/// from where the cells of the wall's relief put them.
void fit_door_sides(const PointCloud& map, const SurfaceSample& sample,
                    const RoomSurfaces& surfaces, std::span<WallOpening> openings,
                    const Context& context = {});

}  // namespace roomscribe
