// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {

/// A closed rim of a planar patch: around it, or around a hole in it.
struct OutlineLoop {
    /// Rim points of the patch in order, in the plane's coordinates (plane_axes): the material lies
    /// to the left, so that outer loops run counter-clockwise and holes clockwise.
    std::vector<Eigen::Vector2d> points;
    bool is_hole = false;
};

struct PatchOutline {
    std::vector<OutlineLoop> loops;
    double cell_size = 0.0;  ///< m, of the raster that it was traced on: gaps under it are closed
    double spacing = 0.0;    ///< m, of the points, were they even
};

/// Outline of the points on a plane: they are entered in a raster whose cells are as small as the
/// spacing of the points allows (`min_cell_size` at least), gaps of one cell are closed, and the
/// rims of what is filled are followed. Each rim cell gives its outermost point, so that the loops
/// are as exact as the points are dense there, also where the raster has to be coarse for the sake
/// of other parts. Loops of fewer than 8 cells are left out. Empty for no points.
PatchOutline trace_outline(std::span<const Eigen::Vector3f> positions,
                           std::span<const std::uint32_t> points, const Plane& plane,
                           double min_cell_size);

}  // namespace roomscribe
