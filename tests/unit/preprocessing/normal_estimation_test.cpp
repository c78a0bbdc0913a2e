// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/normal_estimation.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

PointNormals normals_of(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& sensor,
                        int num_neighbors = 12, int num_threads = 0) {
    return estimate_normals(points, SearchTree(points), sensor, {.num_neighbors = num_neighbors},
                            test::with_threads(num_threads));
}

TEST(EstimateNormals, OfAPlaneLookAtTheSensor) {
    Random random(1);
    for (int run = 0; run < 10; ++run) {
        const Transform pose = test::random_transform(random, 3.0);
        const auto points = test::transformed(test::grid_points(20, 20, 0.05), pose);
        const Eigen::Vector3d normal = pose.linear().col(2);
        for (const double side : {1.0, -1.0}) {
            const Eigen::Vector3d sensor = pose * Eigen::Vector3d(0.4, 0.3, side * 2.0);
            const PointNormals result = normals_of(points, sensor);
            ASSERT_EQ(result.normals.size(), points.size());
            for (std::size_t i = 0; i < points.size(); ++i) {
                EXPECT_THAT(result.normals[i].cast<double>().eval(),
                            test::VectorNear((side * normal).eval(), 1e-4));
                EXPECT_LT(result.residuals[i], 1e-5F);
            }
        }
    }
}

TEST(EstimateNormals, OfASphereAreRadial) {
    Random random(2);
    std::vector<Eigen::Vector3f> points;
    const Eigen::Vector3d center(4.0, -1.0, 2.0);
    for (int i = 0; i < 20'000; ++i) {
        points.emplace_back((center + 1.5 * test::random_direction(random)).cast<float>());
    }
    const PointNormals result = normals_of(points, center, 20);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d inward = (center - points[i].cast<double>()).normalized();
        ASSERT_GT(result.normals[i].cast<double>().dot(inward), std::cos(radians(3.0)));
        ASSERT_NEAR(result.normals[i].norm(), 1.0F, 1e-6F);
    }
}

TEST(EstimateNormals, ResidualIsTheNoise) {
    Random random(3);
    auto points = test::grid_points(60, 60, 0.1);
    for (Eigen::Vector3f& point : points)
        point.z() += static_cast<float>(0.01 * random.normal());
    const PointNormals result = normals_of(points, {3.0, 3.0, 5.0}, 40);
    double sum_of_squares = 0.0;
    for (const float residual : result.residuals) {
        sum_of_squares += static_cast<double>(residual) * static_cast<double>(residual);
    }
    // The fit takes three degrees of freedom.
    const double expected = 0.01 * std::sqrt(37.0 / 40.0);
    EXPECT_NEAR(std::sqrt(sum_of_squares / static_cast<double>(points.size())), expected,
                0.05 * expected);
}

TEST(EstimateNormals, AreNanOnALineAndForTwoPoints) {
    const auto line = test::grid_points(1, 50, 0.1);
    for (const Eigen::Vector3f& normal : normals_of(line, {0, 0, 1}).normals) {
        EXPECT_TRUE(normal.array().isNaN().all());
    }
    const std::vector<Eigen::Vector3f> two = {{0, 0, 0}, {1, 0, 0}};
    const PointNormals result = normals_of(two, {0, 0, 1});
    EXPECT_TRUE(result.normals[1].array().isNaN().all());
    EXPECT_TRUE(std::isnan(result.residuals[1]));
    EXPECT_TRUE(normals_of({}, {0, 0, 1}).normals.empty());
}

TEST(EstimateNormals, HaveTheSameBitsOnAnyThreads) {
    Random random(4);
    const auto points = test::random_points(random, 5000);
    const PointNormals one = normals_of(points, {0, 0, 0}, 15, 1);
    for (const int num_threads : {2, 7}) {
        const PointNormals many = normals_of(points, {0, 0, 0}, 15, num_threads);
        EXPECT_EQ(many.normals, one.normals);
        EXPECT_EQ(many.residuals, one.residuals);
    }
}

TEST(EstimateNormals, ChecksItsSettings) {
    EXPECT_THROW(normals_of({}, {0, 0, 0}, 2), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
