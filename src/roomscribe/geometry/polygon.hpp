// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// The z of the cross product: positive when `b` lies to the left of `a`.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Convex hull, counter-clockwise, without collinear corners (Andrew's monotone chain). Fewer than
/// 3 corners if the points are fewer or on one line.
std::vector<Eigen::Vector2d> convex_hull(std::span<const Eigen::Vector2d> points);

/// Area enclosed by a simple polygon, positive when its corners run counter-clockwise.
double signed_area(std::span<const Eigen::Vector2d> corners);

/// Normal of a planar polygon, by the right hand around its corners, as long as its area in m2
/// (Newell's method); zero for fewer than 3 corners.
Eigen::Vector3d area_vector(std::span<const Eigen::Vector3d> corners);

/// Whether a place lies inside a simple polygon, by the parity of the edges that a ray crosses.
bool is_inside(std::span<const Eigen::Vector2d> corners, const Eigen::Vector2d& place);

}  // namespace roomscribe
