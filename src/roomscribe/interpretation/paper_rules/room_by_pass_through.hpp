// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/interpretation/paper_rules/paper_rules_settings.hpp"
#include "roomscribe/interpretation/rooms/wall_rectangle.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

/// A plane that is a wall, in the map frame.
struct RuleWall {
    std::uint32_t plane = 0;  ///< number of the plane
    Plane face;               ///< the same plane; its normal looks into the room
    Eigen::Vector3d along;    ///< level, within the plane: up x normal
    WallRectangle extent;     ///< m along `along` and along up
};

/// The planes of a room.
struct RuleRoom {
    std::vector<std::uint32_t> floor;    ///< numbers of planes
    std::vector<std::uint32_t> ceiling;  ///< numbers of planes
    std::vector<RuleWall> walls;
    std::optional<double> floor_height;  ///< m along up; empty where no floor was found
    std::optional<double> ceiling_height;
    /// m along up, of the middle 98 % of the planes' points.
    double bottom = 0.0;
    double top = 0.0;
};

/// Floor, ceiling and walls by a pass-through filter along z (the paper's section 4.3) and rules
/// (i) and (ii) of its Table 3. Level planes in the lowest slice of the planes' points are floor,
/// those in the highest are ceiling, if that is about as high above the bottom as walls are or
/// higher. Upright planes along x or y (walls form rectangles, with floor and ceiling cuboids) are
/// walls if they reach the ceiling's slice (section 4.4: "adjacent to the ceiling"); where there is
/// no ceiling, if they are about as high as walls are. A wall reaches from floor to ceiling where
/// these were found, and along as far as the middle 98 % of its points. `room_from_map` has the
/// axes x, y, z as rows. No planes give an empty room.
RuleRoom find_room_by_pass_through(const PointCloud& map, std::span<const PlanarPatch> planes,
                                   const Eigen::Matrix3d& room_from_map,
                                   const PaperRulesSettings& settings = {});

}  // namespace roomscribe
