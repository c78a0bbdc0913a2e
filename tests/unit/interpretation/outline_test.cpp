// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/outline.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

/// A grid of points of the given spacing over [0, width] x [0, depth], less a corner of the given
/// size.
std::vector<Eigen::Vector2d> grid_without_corner(double width, double depth, double corner,
                                                 double spacing) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i <= static_cast<int>(width / spacing + 0.5); ++i) {
        for (int j = 0; j <= static_cast<int>(depth / spacing + 0.5); ++j) {
            const Eigen::Vector2d point(i * spacing, j * spacing);
            const bool in_corner = point.x() > width - corner && point.y() > depth - corner;
            if (!in_corner) points.push_back(point);
        }
    }
    return points;
}

double distance_to_segment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to) {
    const double share =
        std::clamp((point - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (point - from - share * (to - from)).norm();
}

/// 0 inside, else the distance to the polygon.
double distance_outside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& point) {
    bool inside = false;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
        distance = std::min(distance, distance_to_segment(point, a, b));
        const bool crosses = (a.y() > point.y()) != (b.y() > point.y());
        if (crosses &&
            point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
            inside = !inside;
        }
    }
    return inside ? 0.0 : distance;
}

TEST(ConcaveOutline, FollowsTheInnerCornerThatTheHullCutsAcross) {
    constexpr double spacing = 0.05;
    const auto points = grid_without_corner(6.0, 5.0, 2.0, spacing);
    EXPECT_GT(signed_area(convex_hull(points)), 27.5);
    // The rim is good to a spacing of the points, along a circumference of 22 m.
    EXPECT_NEAR(signed_area(concave_outline(points, 0.5, 0.05)), 26.0, spacing * 22.0);
}

TEST(ConcaveOutline, HoldsAllPointsUpToTheTolerance) {
    Random random(7);
    auto points = grid_without_corner(6.0, 5.0, 2.0, 0.1);
    for (Eigen::Vector2d& point : points) {
        point += Eigen::Vector2d(random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04));
    }
    constexpr double tolerance = 0.1;
    const auto outline = concave_outline(points, 0.5, tolerance);
    ASSERT_GE(outline.size(), 6U);
    for (const Eigen::Vector2d& point : points) {
        EXPECT_LE(distance_outside(outline, point), 1.5 * tolerance);
    }
}

TEST(ConcaveOutline, HasFewerThanThreeCornersForPointsOnALine) {
    const std::vector<Eigen::Vector2d> points{{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}};
    EXPECT_LT(concave_outline(points, 0.5, 0.01).size(), 3U);
    EXPECT_TRUE(concave_outline({}, 0.5, 0.01).empty());
}

}  // namespace
}  // namespace roomscribe
