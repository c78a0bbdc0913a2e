// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/interpretation/rooms/floor_plan.hpp"
#include "roomscribe/interpretation/rooms/plan_cell.hpp"
#include "roomscribe/interpretation/rooms/upright_surfaces.hpp"

namespace roomscribe {

/// Marks the cells along which upright surfaces part rooms, and which of these are solid at the
/// height of people. `cells` are the plan's, with ceilings, floors and rays; `floor_height` in m
/// along up. A surface parts where it reaches the ceiling, as a lintel does; where no ceiling was
/// seen, where it is as tall as a wall or nothing lies behind it; and in gaps as wide as a door.
/// The face of a beam, with nothing at the height of people and the room going on below, parts
/// nothing.
void draw_barriers(std::span<const UprightSurface> surfaces, const SurfaceSample& sample,
                   std::span<const PlanarPatch> patches, const Eigen::Matrix3d& room_from_map,
                   double floor_height, const RoomSurfacesSettings& settings, FloorPlan& plan,
                   std::vector<PlanCell>& cells);

}  // namespace roomscribe
