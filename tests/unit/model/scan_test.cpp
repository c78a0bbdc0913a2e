// SPDX-License-Identifier: MIT
#include "roomscribe/model/scan.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

Channel numbers(std::string name, const std::vector<std::uint32_t>& values) {
    Channel channel{std::move(name), ScalarType::uint32, 1, {}};
    channel.values.resize(4 * values.size());
    std::memcpy(channel.values.data(), values.data(), channel.values.size());
    return channel;
}

std::vector<std::uint32_t> values_of(const Channel& channel) {
    std::vector<std::uint32_t> values(channel.values.size() / 4);
    std::memcpy(values.data(), channel.values.data(), channel.values.size());
    return values;
}

Scan make_scan(std::string name, std::vector<Eigen::Vector3f> positions) {
    Scan scan;
    scan.name = std::move(name);
    scan.cloud.positions = std::move(positions);
    return scan;
}

TEST(Scan, SensorIsAtTheOriginUnlessTheFileSaysOtherwise) {
    Scan scan;
    EXPECT_EQ(scan.sensor_position(), Eigen::Vector3d::Zero());
    scan.cloud.sensor_pose = Transform(Eigen::Translation3d(1, 2, 3));
    EXPECT_EQ(scan.sensor_position(), Eigen::Vector3d(1, 2, 3));
}

TEST(MergeScans, KeepsTheOrderAndEveryPoint) {
    const std::vector<Scan> scans = {make_scan("a", {{1, 0, 0}, {NAN, 0, 0}, {2, 0, 0}}),
                                     make_scan("b", {}), make_scan("c", {{0, 1, 0}})};
    const Transform turn(Eigen::AngleAxisd(radians(90.0), Eigen::Vector3d::UnitZ()));
    const Transform shift(Eigen::Translation3d(0, 0, 5));
    const std::vector<std::optional<Transform>> poses = {turn, Transform::Identity(), shift};
    const ScanMap map = merge_scans(scans, poses);

    ASSERT_EQ(map.cloud.size(), 4U);
    EXPECT_THAT(map.cloud.positions[0], test::VectorNear(Eigen::Vector3f(0, 1, 0), 1e-6));
    EXPECT_FALSE(is_finite(map.cloud.positions[1]));
    EXPECT_THAT(map.cloud.positions[2], test::VectorNear(Eigen::Vector3f(0, 2, 0), 1e-6));
    EXPECT_THAT(map.cloud.positions[3], test::VectorNear(Eigen::Vector3f(0, 1, 5), 1e-6));

    ASSERT_EQ(map.sections.size(), 3U);
    EXPECT_EQ(map.sections[0].name, "a");
    EXPECT_EQ(map.sections[1].first, 3U);
    EXPECT_EQ(map.sections[1].count, 0U);
    EXPECT_EQ(map.sections[2].first, 3U);
    EXPECT_EQ(map.sections[2].count, 1U);
    EXPECT_THAT(*map.sections[2].sensor_position,
                test::VectorNear(Eigen::Vector3d(0, 0, 5), 1e-12));
}

TEST(MergeScans, PointsOfAScanWithoutAPlaceAreNan) {
    const std::vector<Scan> scans = {make_scan("a", {{1, 0, 0}}),
                                     make_scan("b", {{2, 0, 0}, {3, 0, 0}})};
    const std::vector<std::optional<Transform>> poses = {Transform::Identity(), std::nullopt};
    const ScanMap map = merge_scans(scans, poses);
    ASSERT_EQ(map.cloud.size(), 3U);
    EXPECT_TRUE(is_finite(map.cloud.positions[0]));
    for (const std::size_t i : {1U, 2U}) {
        EXPECT_TRUE(map.cloud.positions[i].array().isNaN().all());
    }
    EXPECT_TRUE(map.sections[0].sensor_position);
    EXPECT_FALSE(map.sections[1].sensor_position);
}

TEST(MergeScans, KeepsWhatAllScansHave) {
    std::vector<Scan> scans = {make_scan("a", {{1, 0, 0}, {2, 0, 0}}), make_scan("b", {{3, 0, 0}})};
    scans[0].cloud.intensities = {0.1F, 0.2F};
    scans[1].cloud.intensities = {0.3F};
    scans[0].cloud.normals = {{1, 0, 0}, {1, 0, 0}};
    scans[0].cloud.channels = {numbers("time", {1, 2}), numbers("ring", {7, 8})};
    scans[1].cloud.channels = {numbers("other", {5}), numbers("ring", {9})};
    scans[1].cloud.colors = {{1, 2, 3}};
    const std::vector<std::optional<Transform>> poses(2, Transform::Identity());
    const PointCloud cloud = merge_scans(scans, poses).cloud;
    EXPECT_EQ(cloud.intensities, (std::vector<float>{0.1F, 0.2F, 0.3F}));
    EXPECT_TRUE(cloud.normals.empty());
    EXPECT_TRUE(cloud.colors.empty());
    ASSERT_EQ(cloud.channels.size(), 1U);
    EXPECT_EQ(cloud.channels[0].name, "ring");
    EXPECT_EQ(values_of(cloud.channels[0]), (std::vector<std::uint32_t>{7, 8, 9}));
}

TEST(MergeScans, AChannelOfAnotherTypeIsAnotherChannel) {
    std::vector<Scan> scans = {make_scan("a", {{1, 0, 0}}), make_scan("b", {{3, 0, 0}})};
    scans[0].cloud.channels = {numbers("ring", {7})};
    scans[1].cloud.channels = {numbers("ring", {9})};
    scans[1].cloud.channels[0].type = ScalarType::float32;
    const std::vector<std::optional<Transform>> poses(2, Transform::Identity());
    EXPECT_TRUE(merge_scans(scans, poses).cloud.channels.empty());
}

TEST(MergeScans, WantsOnePosePerScan) {
    const std::vector<Scan> scans(2);
    EXPECT_THROW(merge_scans(scans, std::vector<std::optional<Transform>>(1)), InvalidArgument);
    EXPECT_TRUE(merge_scans(std::span<const Scan>(), {}).cloud.empty());
}

TEST(MapOfCloud, KnowsTheSensorOnlyIfTheFileDoes) {
    Scan scan = make_scan("whole", {{1, 2, 3}});
    EXPECT_FALSE(map_of_cloud(scan).sections[0].sensor_position);
    scan.cloud.sensor_pose = Transform(Eigen::Translation3d(1, 2, 3));
    const ScanMap map = map_of_cloud(scan);
    ASSERT_EQ(map.sections.size(), 1U);
    EXPECT_EQ(map.sections[0].name, "whole");
    EXPECT_EQ(map.sections[0].count, 1U);
    EXPECT_EQ(*map.sections[0].sensor_position, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(map.cloud.positions, scan.cloud.positions);
}

}  // namespace
}  // namespace roomscribe
