// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/polygon.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/bounding_box.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

TEST(ConvexHull, LeavesOutInnerAndCollinearPoints) {
    const std::vector<Vector2d> points = {{1, 1}, {0, 0}, {2, 0}, {1, 0}, {2, 2},
                                          {0, 2}, {0, 1}, {2, 2}, {1, 2}};
    EXPECT_THAT(convex_hull(points), testing::ElementsAre(Vector2d(0, 0), Vector2d(2, 0),
                                                          Vector2d(2, 2), Vector2d(0, 2)));
}

TEST(ConvexHull, HasFewerThanThreeCornersWhenFlat) {
    EXPECT_TRUE(convex_hull({}).empty());
    const std::vector<Vector2d> one = {{3, 4}, {3, 4}};
    EXPECT_THAT(convex_hull(one), testing::ElementsAre(Vector2d(3, 4)));
    const std::vector<Vector2d> line = {{3, 3}, {0, 0}, {2, 2}, {1, 1}};
    EXPECT_THAT(convex_hull(line), testing::ElementsAre(Vector2d(0, 0), Vector2d(3, 3)));
}

TEST(ConvexHull, HoldsAllPointsAndTurnsLeft) {
    Random random(1);
    for (int run = 0; run < 50; ++run) {
        std::vector<Vector2d> points;
        for (int i = 0; i < 100; ++i)
            points.emplace_back(random.normal(), random.normal());
        const std::vector<Vector2d> hull = convex_hull(points);
        ASSERT_GE(hull.size(), 3U);
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
            const Vector2d left(-edge.y(), edge.x());
            EXPECT_GT(left.dot(hull[(i + 2) % hull.size()] - hull[i]), 0.0);
            for (const Vector2d& point : points) {
                EXPECT_GE(left.dot(point - hull[i]), -1e-12);
            }
        }
    }
}

TEST(SignedArea, OfKnownShapes) {
    const std::vector<Vector2d> l_shape = {{0, 0}, {6, 0}, {6, 3}, {2, 3}, {2, 5}, {0, 5}};
    EXPECT_DOUBLE_EQ(signed_area(l_shape), 22.0);
    const std::vector<Vector2d> reversed(l_shape.rbegin(), l_shape.rend());
    EXPECT_DOUBLE_EQ(signed_area(reversed), -22.0);
    EXPECT_EQ(signed_area({}), 0.0);

    std::vector<Vector2d> circle;
    constexpr int corners = 360;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners;
        circle.emplace_back(10.0 + std::cos(angle), std::sin(angle) - 4.0);
    }
    EXPECT_NEAR(signed_area(circle), 0.5 * corners * std::sin(2.0 * std::numbers::pi / corners),
                1e-10);
}

TEST(AreaVector, StandsOnThePolygonAsLongAsItsArea) {
    // An L of 3 m2 in the plane x = 5.
    const std::vector<Eigen::Vector3d> corners = {{5, 0, 0}, {5, 2, 0}, {5, 2, 1},
                                                  {5, 1, 1}, {5, 1, 2}, {5, 0, 2}};
    EXPECT_TRUE(area_vector(corners).isApprox(Eigen::Vector3d(3, 0, 0)));
    EXPECT_EQ(area_vector(std::span(corners).first(2)), Eigen::Vector3d::Zero());
}

TEST(IsInside, TellsTheNotchOfAnLFromItsArms) {
    const std::vector<Eigen::Vector2d> corners = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    EXPECT_TRUE(is_inside(corners, {1.5, 0.5}));
    EXPECT_TRUE(is_inside(corners, {0.5, 1.5}));
    EXPECT_FALSE(is_inside(corners, {1.5, 1.5}));
    EXPECT_FALSE(is_inside(corners, {-0.5, 1.0}));
    EXPECT_FALSE(is_inside({}, {0, 0}));
}

TEST(BoundingBox, HoldsTheFinitePoints) {
    const std::vector<Eigen::Vector3f> points = {
        {1, -2, 3}, {NAN, 0, 0}, {-1, 5, 0}, {INFINITY, 0, 0}, {0, 0, 7}};
    const Eigen::AlignedBox3f box = bounding_box(points);
    EXPECT_EQ(box.min(), Eigen::Vector3f(-1, -2, 0));
    EXPECT_EQ(box.max(), Eigen::Vector3f(1, 5, 7));
    EXPECT_TRUE(bounding_box({}).isEmpty());
    EXPECT_TRUE(bounding_box(std::span(points).subspan(1, 1)).isEmpty());
}

}  // namespace
}  // namespace roomscribe
