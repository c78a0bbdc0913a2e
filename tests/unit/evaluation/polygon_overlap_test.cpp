// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/polygon_overlap.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

Corners rectangle(double x, double y, double width, double height) {
    return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

Corners reversed(Corners corners) {
    return {corners.rbegin(), corners.rend()};
}

TEST(PolygonOverlap, OfRectanglesIsThatOfIntervals) {
    const Corners unit = rectangle(0, 0, 1, 1);
    EXPECT_DOUBLE_EQ(overlap_area(unit, unit), 1.0);
    EXPECT_DOUBLE_EQ(overlap_area(unit, rectangle(0.25, 0.5, 2, 2)), 0.375);
    EXPECT_DOUBLE_EQ(overlap_area(unit, rectangle(0.25, 0.25, 0.5, 0.5)), 0.25);
    EXPECT_DOUBLE_EQ(overlap_area(unit, rectangle(1, 0, 1, 1)), 0.0);
    EXPECT_DOUBLE_EQ(overlap_area(unit, rectangle(3, 3, 1, 1)), 0.0);
    EXPECT_DOUBLE_EQ(polygon_iou(unit, rectangle(0.5, 0, 1, 1)), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(polygon_iou(unit, reversed(rectangle(0.5, 0, 1, 1))), 1.0 / 3.0);
}

TEST(PolygonOverlap, OfASquareAndItselfTurnedIsAnOctagon) {
    const Corners square = rectangle(-1, -1, 2, 2);
    const double corner = std::sqrt(2.0);
    const Corners turned{{corner, 0}, {0, corner}, {-corner, 0}, {0, -corner}};
    EXPECT_NEAR(overlap_area(square, turned), 8.0 * (std::sqrt(2.0) - 1.0), 1e-12);
}

TEST(PolygonOverlap, TakesPolygonsThatAreNotConvex) {
    const Corners l_shape{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    EXPECT_DOUBLE_EQ(overlap_area(l_shape, l_shape), 3.0);
    EXPECT_DOUBLE_EQ(overlap_area(l_shape, rectangle(0.5, 0.5, 1, 1)), 0.75);
    EXPECT_DOUBLE_EQ(overlap_area(l_shape, rectangle(1, 1, 1, 1)), 0.0);
    // A comb: seen from its first corner it is far from star-shaped.
    const Corners comb{{0, 0}, {5, 0}, {5, 2}, {4, 2}, {4, 1}, {3, 1},
                       {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    EXPECT_NEAR(overlap_area(comb, rectangle(0, 1, 5, 1)), 3.0, 1e-12);
    EXPECT_NEAR(overlap_area(comb, reversed(comb)), 8.0, 1e-12);
}

TEST(PolygonOverlap, OfWhatEnclosesNothingIsZero) {
    const Corners unit = rectangle(0, 0, 1, 1);
    EXPECT_EQ(overlap_area(unit, {}), 0.0);
    EXPECT_EQ(overlap_area(Corners{{0, 0}, {1, 1}}, unit), 0.0);
    EXPECT_EQ(polygon_iou(Corners{{0, 0}, {1, 1}, {2, 2}}, Corners{}), 0.0);
}

/// Corners around the origin at random distances: simple, mostly not convex.
Corners star(Random& random, std::size_t num_corners) {
    Corners corners;
    for (std::size_t i = 0; i < num_corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * (static_cast<double>(i) + random.uniform()) /
                             static_cast<double>(num_corners);
        corners.emplace_back(random.uniform(0.2, 1.0) *
                             Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    return corners;
}

bool is_inside(const Corners& polygon, const Eigen::Vector2d& point) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        if (point.x() < x) inside = !inside;
    }
    return inside;
}

RC_GTEST_PROP(PolygonOverlap, AgreesWithCountingPoints, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Corners a = star(random, 3 + random.below(6));
    Corners b = star(random, 3 + random.below(6));
    for (Eigen::Vector2d& corner : b)
        corner += Eigen::Vector2d(0.3, 0.1);
    constexpr int steps = 200;
    const double side = 2.8 / steps;
    int inside = 0;
    for (int row = 0; row < steps; ++row) {
        for (int column = 0; column < steps; ++column) {
            const Eigen::Vector2d point(-1.4 + side * (column + 0.5), -1.4 + side * (row + 0.5));
            inside += is_inside(a, point) && is_inside(b, point) ? 1 : 0;
        }
    }
    const double shared = overlap_area(a, b);
    RC_ASSERT(std::abs(shared - inside * side * side) < 0.03);
    RC_ASSERT(std::abs(shared - overlap_area(b, a)) < 1e-12);
    RC_ASSERT(shared <= std::min(std::abs(signed_area(a)), std::abs(signed_area(b))) + 1e-12);
}

}  // namespace
}  // namespace roomscribe
