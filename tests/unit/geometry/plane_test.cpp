// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/plane.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using test::VectorNear;

/// Points of a rectangle with edges `length` and `width`, turned and shifted.
std::vector<Eigen::Vector3f> rectangle(Random& random, const Transform& pose, double length,
                                       double width, std::size_t count = 500) {
    std::vector<Eigen::Vector3f> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d point(random.uniform(-0.5, 0.5) * length,
                                    random.uniform(-0.5, 0.5) * width, 0.0);
        points.emplace_back((pose * point).cast<float>());
    }
    return points;
}

TEST(Plane, MeasuresAndProjects) {
    const Plane plane{Eigen::Vector3d(0.6, 0.0, 0.8), 2.0};
    const Eigen::Vector3d point(3.0, -7.0, 4.0);
    EXPECT_DOUBLE_EQ(plane.signed_distance(point), 3.0);
    EXPECT_DOUBLE_EQ(plane.flipped().signed_distance(point), -3.0);
    EXPECT_NEAR(plane.signed_distance(plane.project(point)), 0.0, 1e-12);
    EXPECT_THAT(plane.project(point), VectorNear(point - 3.0 * plane.normal, 1e-12));
}

TEST(Plane, AxesCompleteARightHandedFrame) {
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        Eigen::Vector3d normal = test::random_direction(random);
        if (i < 6) normal = (i < 3 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(i % 3);
        const PlaneAxes axes = plane_axes(normal);
        EXPECT_NEAR(axes.u.norm(), 1.0, 1e-12);
        EXPECT_NEAR(axes.v.norm(), 1.0, 1e-12);
        EXPECT_THAT(axes.u.cross(axes.v).eval(), VectorNear(normal, 1e-12));
    }
}

TEST(FitPlane, FindsExactPlanes) {
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const Transform pose = test::random_transform(random, 5.0);
        const auto fit = fit_plane(rectangle(random, pose, 4.0, 1.0));
        ASSERT_TRUE(fit);
        EXPECT_NEAR(fit->plane.normal.norm(), 1.0, 1e-12);
        EXPECT_NEAR(std::abs(fit->plane.normal.dot(pose.linear().col(2))), 1.0, 1e-12);
        EXPECT_NEAR(fit->plane.signed_distance(pose.translation()), 0.0, 1e-6);
        EXPECT_LT(fit->rms, 1e-6);
    }
}

TEST(FitPlane, HasTheVariancesOfTheShape) {
    // Corners and centre of a 4 x 2 rectangle, and two points 1 above and below the centre.
    const std::vector<Eigen::Vector3f> points = {{2, 1, 0}, {2, -1, 0}, {-2, 1, 0}, {-2, -1, 0},
                                                 {0, 0, 0}, {0, 0, 1},  {0, 0, -1}};
    const auto fit = fit_plane(points);
    ASSERT_TRUE(fit);
    EXPECT_THAT(fit->variances, VectorNear(Eigen::Vector3d(2.0, 4.0, 16.0) / 7.0, 1e-12));
    EXPECT_NEAR(fit->rms, std::sqrt(2.0 / 7.0), 1e-12);
    EXPECT_NEAR(std::abs(fit->plane.normal.z()), 1.0, 1e-12);
}

TEST(FitPlane, IsEmptyOnALineAndForFewPoints) {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Transform pose = test::random_transform(random, 3.0);
        EXPECT_FALSE(fit_plane(rectangle(random, pose, 2.0, 0.0)));
    }
    const std::vector<Eigen::Vector3f> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_FALSE(fit_plane(std::span(points).first(0)));
    EXPECT_FALSE(fit_plane(std::span(points).first(2)));
    EXPECT_TRUE(fit_plane(points));
    EXPECT_FALSE(fit_plane(std::vector<Eigen::Vector3f>(10, Eigen::Vector3f(1, 2, 3))));
}

TEST(FitPlane, KeepsItsAccuracyFarFromTheOrigin) {
    // 100 km out float32 has steps of 8 mm: what is left is their rounding, not the sums'.
    std::vector<Eigen::Vector3f> points;
    for (int x = 0; x < 32; ++x) {
        for (int y = 0; y < 32; ++y) {
            points.emplace_back(100'000.0F + 0.125F * static_cast<float>(x),
                                -100'000.0F + 0.125F * static_cast<float>(y),
                                100'000.0F + 0.125F * static_cast<float>(x - y));
        }
    }
    const auto fit = fit_plane(points);
    ASSERT_TRUE(fit);
    const Eigen::Vector3d normal = Eigen::Vector3d(1.0, -1.0, -1.0).normalized();
    EXPECT_NEAR(std::abs(fit->plane.normal.dot(normal)), 1.0, 1e-12);
    EXPECT_LT(fit->rms, 1e-6);
}

TEST(FitPlane, TakesTheIndexedPointsAlone) {
    const std::vector<Eigen::Vector3f> points = {
        {0, 0, 5}, {9, 9, 9}, {1, 0, 5}, {0, 1, 5}, {-8, 7, 6}};
    const std::vector<std::uint32_t> indices = {0, 2, 3};
    const auto fit = fit_plane(points, indices);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->plane.signed_distance({0.3, 0.3, 5.0}), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(fit->plane.normal.z()), 1.0, 1e-12);
}

TEST(PlaneMoments, FitGoesOnWhilePointsAreAdded) {
    Random random(4);
    const auto points = test::random_points(random, 60);
    PlaneMoments moments;
    for (std::size_t i = 0; i < points.size(); ++i) {
        moments.add(points[i].cast<double>());
        const auto expected = fit_plane(std::span(points).first(i + 1));
        const auto fit = moments.fit();
        ASSERT_EQ(fit.has_value(), expected.has_value());
        if (fit) {
            EXPECT_EQ(fit->plane.normal, expected->plane.normal);
        }
    }
}

TEST(PlaneMoments, SumsOfPartsAreThoseOfTheWhole) {
    Random random(6);
    PlaneMoments whole;
    PlaneMoments parts[3];
    for (int i = 0; i < 60; ++i) {
        const Eigen::Vector3d point(100.0 + random.normal(), 0.5 * random.normal(),
                                    -7.0 + 0.01 * random.normal());
        whole.add(point);
        parts[i < 7 ? 0 : 1].add(point);
    }
    PlaneMoments sum;
    for (const PlaneMoments& part : parts)
        sum += part;
    const auto expected = whole.fit();
    const auto found = sum.fit();
    ASSERT_TRUE(expected && found);
    EXPECT_EQ(sum.count, 60U);
    EXPECT_NEAR(found->rms, expected->rms, 1e-12);
    EXPECT_LT((found->centroid - expected->centroid).norm(), 1e-12);
    EXPECT_GT(std::abs(found->plane.normal.dot(expected->plane.normal)), 1.0 - 1e-12);
}

}  // namespace
}  // namespace roomscribe
