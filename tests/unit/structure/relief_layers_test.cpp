// SPDX-License-Identifier: MIT
#include "roomscribe/structure/relief_layers.hpp"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "flat_clouds.hpp"

namespace roomscribe {
namespace {

/// A wall of 3 x 2.5 m in the plane z = 0 with relief.
PointCloud wall(double noise, const std::function<double(double, double)>& relief,
                double step = 0.02) {
    Random random(3);
    PointCloud cloud;
    test::add_rectangle(cloud, Eigen::Vector3d::Zero(), 3.0 * Eigen::Vector3d::UnitX(),
                        2.5 * Eigen::Vector3d::UnitY(), step, noise, random, relief);
    return cloud;
}

ReliefLayers layers_of(const PointCloud& cloud, double noise) {
    std::vector<ReliefPoint> points;
    for (std::uint32_t i = 0; i < cloud.size(); ++i)
        points.push_back({i, static_cast<float>(noise)});
    return find_relief_layers(cloud.positions, points, Plane{}, 0.25);
}

/// Number of points per layer, the most first.
std::vector<std::size_t> sizes_of(const ReliefLayers& layers) {
    std::vector<std::size_t> sizes(layers.num_layers, 0);
    for (const std::uint32_t layer : layers.layer_of_point) {
        if (layer != no_layer) ++sizes[layer];
    }
    std::sort(sizes.rbegin(), sizes.rend());
    return sizes;
}

bool is_on_picture(double x, double y) {
    return test::is_within(x, 1.0, 1.8) && test::is_within(y, 1.2, 1.8);
}

TEST(FindReliefLayers, TellsAPictureFromItsWall) {
    for (const double noise : {0.0, 0.002, 0.004}) {
        SCOPED_TRACE(noise);
        const PointCloud cloud =
            wall(noise, [](double x, double y) { return is_on_picture(x, y) ? 0.015 : 0.0; });
        const ReliefLayers layers = layers_of(cloud, noise);
        ASSERT_GE(layers.num_layers, 2U);
        std::size_t wrong = 0;
        const std::uint32_t of_wall = layers.layer_of_point.front();
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const Eigen::Vector3f& p = cloud.positions[i];
            const bool is_picture =
                is_on_picture(static_cast<double>(p.x()), static_cast<double>(p.y()));
            wrong += (layers.layer_of_point[i] == of_wall) == is_picture ? 1 : 0;
        }
        EXPECT_LT(static_cast<double>(wrong), 0.03 * static_cast<double>(cloud.size()));
        EXPECT_GT(sizes_of(layers)[1], 900U);  // of 1200
    }
}

TEST(FindReliefLayers, FollowsAWallThatIsOutOfTrue) {
    const PointCloud cloud = wall(0.0015, [](double x, double y) {
        return 0.008 * std::sin(std::numbers::pi * x / 3.0) * std::cos(std::numbers::pi * y / 2.5);
    });
    const std::vector<std::size_t> sizes = sizes_of(layers_of(cloud, 0.0015));
    EXPECT_GT(static_cast<double>(sizes[0]), 0.98 * static_cast<double>(cloud.size()));
}

TEST(FindReliefLayers, LeavesOutWhatStandsAlone) {
    PointCloud cloud = wall(0.001, [](double, double) { return 0.0; });
    cloud.positions.emplace_back(1.0F, 1.0F, 0.02F);
    const ReliefLayers layers = layers_of(cloud, 0.001);
    EXPECT_EQ(layers.layer_of_point.back(), no_layer);
    EXPECT_EQ(sizes_of(layers).size(), 1U);
}

TEST(FindReliefLayers, FindsNoneInFolds) {
    const PointCloud cloud = wall(
        0.001, [](double x, double) { return 0.02 * std::sin(40.0 * x); }, 0.005);
    EXPECT_EQ(layers_of(cloud, 0.001).num_layers, 0U);
}

TEST(FindReliefLayers, OfNoPointsThereAreNone) {
    EXPECT_EQ(find_relief_layers({}, {}, Plane{}, 0.25).num_layers, 0U);
}

}  // namespace
}  // namespace roomscribe
