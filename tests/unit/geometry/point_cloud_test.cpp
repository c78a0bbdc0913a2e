// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/point_cloud.hpp"

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

/// Four points with all that a cloud can have; the channel holds (i, 10 i) per point i.
PointCloud full_cloud() {
    PointCloud cloud;
    Channel channel{"pair", ScalarType::uint16, 2, {}};
    for (std::uint16_t i = 0; i < 4; ++i) {
        const auto value = static_cast<float>(i);
        cloud.positions.emplace_back(value, 2.0F * value, -value);
        cloud.normals.emplace_back(Eigen::Vector3f::Unit(i % 3));
        cloud.colors.push_back({static_cast<std::uint8_t>(i), 0, 255});
        cloud.intensities.push_back(0.5F * value);
        for (const std::uint16_t number : {i, static_cast<std::uint16_t>(10 * i)}) {
            channel.values.resize(channel.values.size() + 2);
            std::memcpy(channel.values.data() + channel.values.size() - 2, &number, 2);
        }
    }
    cloud.channels.push_back(channel);
    cloud.grid = ScanGrid{2, 2};
    cloud.sensor_pose = Transform(Eigen::Translation3d(0, 0, 1));
    cloud.global_shift = {1e6, 2e6, 0.0};
    return cloud;
}

TEST(PointCloud, SelectsPointsWithAllTheyHave) {
    const std::vector<std::uint32_t> indices = {3, 1, 1};
    const PointCloud selected = select_points(full_cloud(), indices);
    const PointCloud all = full_cloud();
    ASSERT_EQ(selected.size(), 3U);
    ASSERT_EQ(selected.channels.size(), 1U);
    EXPECT_EQ(selected.channels[0].name, "pair");
    ASSERT_EQ(selected.channels[0].values.size(), 12U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(selected.positions[i], all.positions[indices[i]]);
        EXPECT_EQ(selected.normals[i], all.normals[indices[i]]);
        EXPECT_EQ(selected.colors[i], all.colors[indices[i]]);
        EXPECT_EQ(selected.intensities[i], all.intensities[indices[i]]);
        EXPECT_EQ(std::memcmp(&selected.channels[0].values[4 * i],
                              &all.channels[0].values[4 * indices[i]], 4),
                  0);
    }
    EXPECT_FALSE(selected.grid);
    ASSERT_TRUE(selected.sensor_pose);
    EXPECT_EQ(selected.global_shift, all.global_shift);
}

TEST(PointCloud, SelectsFromBareCloudsAndNothing) {
    PointCloud bare;
    bare.positions = {{1, 2, 3}};
    const PointCloud selected = select_points(bare, std::vector<std::uint32_t>{0, 0});
    EXPECT_EQ(selected.size(), 2U);
    EXPECT_TRUE(selected.normals.empty());
    EXPECT_TRUE(select_points(full_cloud(), {}).empty());
}

TEST(PointCloud, FindsFinitePoints) {
    PointCloud cloud;
    cloud.positions = {{0, 0, 0}, {NAN, 0, 0}, {0, -INFINITY, 0}, {1, 1, 1}};
    EXPECT_THAT(finite_points(cloud), testing::ElementsAre(0U, 3U));
}

TEST(PointCloud, TransformMovesPointsAndTurnsNormals) {
    Random random(1);
    const Transform motion = test::random_transform(random, 3.0);
    const PointCloud before = full_cloud();
    PointCloud moved = before;
    transform_in_place(moved, motion);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_THAT(moved.positions[i].cast<double>().eval(),
                    test::VectorNear(motion * before.positions[i].cast<double>(), 1e-5));
        EXPECT_THAT(moved.normals[i].cast<double>().eval(),
                    test::VectorNear(motion.linear() * before.normals[i].cast<double>(), 1e-6));
    }
    EXPECT_THAT(*moved.sensor_pose,
                test::TransformNear(motion * *before.sensor_pose, 1e-12, 1e-12));
    EXPECT_EQ(moved.colors, before.colors);
    EXPECT_EQ(moved.channels[0].values, before.channels[0].values);
    EXPECT_TRUE(moved.grid);
}

TEST(PointCloud, TransformKeepsNanPointsNan) {
    PointCloud cloud;
    cloud.positions = {{NAN, 0, 0}, {0, 0, 0}};
    Random random(2);
    transform_in_place(cloud, test::random_transform(random));
    EXPECT_FALSE(is_finite(cloud.positions[0]));
    EXPECT_TRUE(is_finite(cloud.positions[1]));
}

TEST(ScalarType, SizesInBytes) {
    EXPECT_EQ(size_of(ScalarType::uint8), 1U);
    EXPECT_EQ(size_of(ScalarType::int16), 2U);
    EXPECT_EQ(size_of(ScalarType::float32), 4U);
    EXPECT_EQ(size_of(ScalarType::float64), 8U);
    EXPECT_EQ((Channel{"a", ScalarType::int64, 3, {}}.bytes_per_point()), 24U);
}

}  // namespace
}  // namespace roomscribe
