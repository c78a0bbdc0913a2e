// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

#include "roomscribe/interpretation/rooms/floor_plan.hpp"
#include "roomscribe/interpretation/rooms/level_surfaces.hpp"
#include "roomscribe/interpretation/rooms/ray_sample.hpp"
#include "roomscribe/interpretation/rooms/upright_surfaces.hpp"

namespace roomscribe {

/// Rooms are where floor or ceiling was seen, or rays passed through close to it, parted by upright
/// surfaces. A surface parts rooms along its line where it reaches up to the ceiling, as a lintel
/// does over a door, and not as furniture does; where no ceiling was seen, where it is taller than
/// furniture. Gaps as wide as doors between pieces of one line are parted too. What parts only
/// high up along a long line, as beams and steps of the ceiling do, parts no rooms.
///
/// Around a scanner, what its rays passed through is a room as far as it cannot look down; where it
/// saw nothing level, as far as it saw. Of a storey without either there are no rooms.
FloorPlan draw_floor_plan(std::span<const Ray> rays, const SurfaceSample& sample,
                          std::span<const PlanarPatch> patches,
                          const Eigen::Matrix3d& room_from_map, const Storey& storey,
                          std::span<const UprightSurface> surfaces,
                          const RoomSurfacesSettings& settings);

}  // namespace roomscribe
