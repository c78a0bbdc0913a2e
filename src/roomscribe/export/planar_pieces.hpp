// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// Corners in a plane, counter-clockwise.
using PlanePolygon = std::vector<Eigen::Vector2d>;

/// A rectangle along the axes of a plane, in metres.
struct PlaneRectangle {
    Eigen::Vector2d low = Eigen::Vector2d::Zero();
    Eigen::Vector2d high = Eigen::Vector2d::Zero();
};

/// A simple polygon, running either way, as convex pieces that cover it without overlap: itself
/// where it is convex, else triangles (ear clipping). None if it encloses no area. Of a polygon
/// that crosses itself, the ears that can be found.
std::vector<PlanePolygon> convex_pieces(std::span<const Eigen::Vector2d> corners);

/// What is left of convex pieces without the rectangles: again convex pieces, in their order.
std::vector<PlanePolygon> without_rectangles(std::vector<PlanePolygon> pieces,
                                             std::span<const PlaneRectangle> rectangles);

/// m2
double total_area(std::span<const PlanePolygon> pieces);

}  // namespace roomscribe
