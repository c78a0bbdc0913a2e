// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/interpretation/rooms/floor_plan.hpp"
#include "roomscribe/interpretation/rooms/wall_faces.hpp"

namespace roomscribe {

/// The outline of a room: the rim of its cells without steps, counter-clockwise, in the plan's
/// coordinates. Empty for a room without cells.
std::vector<Eigen::Vector2d> trace_room(const FloorPlan& plan, std::int32_t room);

/// Gives to each room what lies between it and its walls, to 2 m deep: furniture before a wall
/// hides floor and ceiling there, but no room ends at furniture.
void fill_to_walls(FloorPlan& plan, std::span<const WallFace> faces,
                   const Eigen::Matrix3d& room_from_map);

/// The room's outline with its edges moved onto the wall faces that they run along.
std::vector<Eigen::Vector2d> outline_between_walls(std::span<const Eigen::Vector2d> outline,
                                                   std::span<const WallFace> faces,
                                                   std::int32_t room,
                                                   const Eigen::Matrix3d& room_from_map);

}  // namespace roomscribe
