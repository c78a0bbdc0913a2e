// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scan_statistics.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/shapes.hpp"

namespace roomscribe {
namespace {

ScanStatistics statistics_of(std::vector<Eigen::Vector3f> positions) {
    PointCloud cloud;
    cloud.positions = std::move(positions);
    return estimate_scan_statistics(cloud);
}

/// Floor and two walls of a corner, sampled on a grid, turned in any way.
std::vector<Eigen::Vector3f> corner(Random& random, double spacing, double noise) {
    const auto edge = static_cast<std::size_t>(4.0 / spacing);
    std::vector<Eigen::Vector3f> points;
    for (const Eigen::Vector3f& point : test::grid_points(edge, edge, spacing)) {
        for (int axis = 0; axis < 3; ++axis) {
            Eigen::Vector3f turned(point.z(), point.x(), point.y());
            if (axis > 0) std::rotate(turned.begin(), turned.begin() + axis, turned.end());
            points.push_back(turned);
        }
    }
    test::add_noise(points, noise, random);
    return test::transformed(points, test::random_transform(random, 10.0));
}

TEST(ScanStatistics, MeasuresSpacingAndNoise) {
    Random random(1);
    for (const auto& [spacing, noise] :
         {std::pair(0.05, 0.005), std::pair(0.05, 0.015), std::pair(0.03, 0.001)}) {
        const ScanStatistics statistics = statistics_of(corner(random, spacing, noise));
        EXPECT_NEAR(statistics.point_spacing, spacing, 0.25 * spacing);
        EXPECT_NEAR(statistics.noise, noise, 0.25 * noise);
    }
}

TEST(ScanStatistics, StepsOfDepthAreNoiseToo) {
    // Slanted ground as a camera sees it that knows depth in steps of 2 cm: on one step the nearest
    // points lie in one plane exactly.
    constexpr float step = 0.02F;
    std::vector<Eigen::Vector3f> points = test::grid_points(400, 400, 0.01);
    for (Eigen::Vector3f& point : points)
        point.z() = step * std::round(0.3F * point.x() / step);
    EXPECT_NEAR(statistics_of(points).noise, static_cast<double>(step) / std::sqrt(12.0), 0.003);
}

TEST(ScanStatistics, ShapeIsNoNoiseInLargeAndThinClouds) {
    Random random(3);
    // A floor of 40 m, a point each 10 cm, with platforms 2 m wide.
    std::vector<Eigen::Vector3f> points = test::grid_points(400, 400, 0.1);
    for (Eigen::Vector3f& point : points) {
        const int squares = static_cast<int>(std::floor(point.x() / 2.0F)) +
                            static_cast<int>(std::floor(point.y() / 2.0F));
        if (squares % 2 != 0) point.z() += 0.4F;
    }
    test::add_noise(points, 0.01, random);
    EXPECT_NEAR(statistics_of(points).noise, 0.01, 0.003);
}

TEST(ScanStatistics, FindsNoNoiseWhereThereIsNone) {
    Random random(2);
    const ScanStatistics statistics = statistics_of(corner(random, 0.05, 0.0));
    EXPECT_NEAR(statistics.point_spacing, 0.05, 0.0125);
    EXPECT_LT(statistics.noise, 1e-5);
}

TEST(ScanStatistics, ExtentIsThatOfTheMiddlePoints) {
    std::vector<Eigen::Vector3f> points = test::grid_points(101, 101, 0.04);
    points.emplace_back(1000.0F, -1000.0F, 1000.0F);
    const ScanStatistics statistics = statistics_of(points);
    EXPECT_EQ(statistics.num_points, points.size());
    EXPECT_NEAR(statistics.extent, 0.98 * 4.0 * std::sqrt(2.0), 0.06);
    EXPECT_NEAR(statistics.point_spacing, 0.04, 0.01);
}

TEST(ScanStatistics, TheDenseZoneDoesNotDecide) {
    std::vector<Eigen::Vector3f> points = test::grid_points(80, 80, 0.05);
    for (Eigen::Vector3f point : test::grid_points(100, 100, 0.002)) {
        point += Eigen::Vector3f(2.0F, 2.0F, 0.0F);
        points.push_back(point);
    }
    EXPECT_NEAR(statistics_of(points).point_spacing, 0.05, 0.0125);
}

TEST(ScanStatistics, CountsFinitePointsAlone) {
    std::vector<Eigen::Vector3f> points = test::grid_points(20, 20, 0.1);
    const ScanStatistics expected = statistics_of(points);
    points.insert(points.begin() + 50, 30, Eigen::Vector3f(NAN, NAN, NAN));
    points.emplace_back(INFINITY, 0.0F, 0.0F);
    const ScanStatistics statistics = statistics_of(points);
    EXPECT_EQ(statistics.num_points, 400U);
    EXPECT_EQ(statistics.point_spacing, expected.point_spacing);
    EXPECT_EQ(statistics.noise, expected.noise);
}

TEST(ScanStatistics, AreZeroForNothingToMeasure) {
    for (const auto& points :
         {std::vector<Eigen::Vector3f>{}, std::vector<Eigen::Vector3f>{{0, 0, 0}, {1, 0, 0}},
          std::vector<Eigen::Vector3f>(100, Eigen::Vector3f(1, 2, 3)),
          std::vector<Eigen::Vector3f>(100, Eigen::Vector3f(NAN, 2, 3))}) {
        const ScanStatistics statistics = statistics_of(points);
        EXPECT_EQ(statistics.point_spacing, 0.0);
        EXPECT_EQ(statistics.noise, 0.0);
        EXPECT_EQ(statistics.extent, 0.0);
    }
}

TEST(ScanStatistics, ManageThreePoints) {
    const ScanStatistics statistics = statistics_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_NEAR(statistics.extent, std::sqrt(2.0), 1e-6);
    EXPECT_GT(statistics.point_spacing, 0.5);
    EXPECT_LT(statistics.point_spacing, 2.5);
    EXPECT_LT(statistics.noise, 1e-6);
}

TEST(ScanStatistics, ManageTinyClouds) {
    // A scan in the wrong unit, or one spot measured again and again.
    const ScanStatistics statistics = statistics_of(test::grid_points(20, 20, 1e-7));
    EXPECT_NEAR(statistics.point_spacing, 1e-7, 0.5e-7);
}

}  // namespace
}  // namespace roomscribe
