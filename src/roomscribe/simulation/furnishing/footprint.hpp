// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// A rectangle on the floor with a range of heights.
struct Footprint {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< unit, along the first half extent
    Eigen::Vector2d half = Eigen::Vector2d::Zero();
    double low = 0.0;
    double high = 0.0;

    Eigen::Vector2d corner(double along, double across) const {
        return center + along * half.x() * axis +
               across * half.y() * Eigen::Vector2d(-axis.y(), axis.x());
    }
    double distance(const Eigen::Vector2d& point) const;  ///< 0 inside
};

/// Of a box in an item's frame.
Footprint footprint_of(const ItemPlan& item, const Eigen::AlignedBox3d& extent);

/// Before a stretch of a wall, `depth` deep; without heights.
Footprint before_wall(const BuiltWallFace& wall, double low, double high, double depth);

/// True if a wall comes nearer than `margin`.
bool touches(const BuiltWallFace& wall, const Footprint& footprint, double margin);

/// True if they come nearer than `margin` sideways and share some height.
bool overlap(const Footprint& a, const Footprint& b, double margin);

}  // namespace roomscribe
