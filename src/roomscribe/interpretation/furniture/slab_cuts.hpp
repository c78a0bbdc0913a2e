// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"

namespace roomscribe {

/// A line in the plan across a slab that parts it in two.
struct SlabCut {
    Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
    double at = 0.0;    ///< m along `direction`
    double area = 0.0;  ///< m2, of the rectangles that hold the parts, where these were sought
};

/// Where a slab that is several tops or seats is to be cut first: between the seats of two chairs;
/// between desks in a row; where rectangles hold an L or tables at angles more tightly; else in
/// half if it is larger than a table. Nothing for what is one top. `places` are those of its
/// voxels.
std::optional<SlabCut> choose_slab_cut(const FurnitureVoxels& all,
                                       std::span<const Eigen::Vector2d> places,
                                       const LevelSlab& slab, double voxel_size);

}  // namespace roomscribe
