// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

namespace roomscribe {

/// Area that two simple polygons share, exact but for rounding: both are taken apart into signed
/// triangles from their first corner, and the triangles are clipped against each other (Sutherland
/// and Hodgman 1974). Corners may run either way round. 0 for a polygon of fewer than 3 corners.
double overlap_area(std::span<const Eigen::Vector2d> a, std::span<const Eigen::Vector2d> b);

/// Shared area over the area of both together, in [0, 1]; 0 if both are empty.
double polygon_iou(std::span<const Eigen::Vector2d> a, std::span<const Eigen::Vector2d> b);

}  // namespace roomscribe
