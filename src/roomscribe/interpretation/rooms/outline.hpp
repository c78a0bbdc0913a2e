// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// A simple polygon around the points, counter-clockwise, that follows them more closely than their
/// convex hull: from the hull, every edge longer than `max_edge` is bent inwards to the point that
/// it meets first, until there is none left to meet (after Park and Oh 2012). Then corners that lie
/// within `tolerance` of the line between their neighbours are left out, so that the polygon holds
/// all points up to about `tolerance`. Fewer than 3 corners if the points are fewer or on one line.
std::vector<Eigen::Vector2d> concave_outline(std::span<const Eigen::Vector2d> points,
                                             double max_edge, double tolerance);

}  // namespace roomscribe
