// SPDX-License-Identifier: MIT
#include "roomscribe/io/rosbag.hpp"

#include <cmath>

#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/rosbag_bytes.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

std::vector<FileContents> read_bag(const std::string& bytes) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.bag", bytes);
    return read_rosbag(folder / "a.bag", PointsAs::cloud, {});
}

void expect_refused(const std::string& bytes, const std::string& reason) {
    try {
        read_bag(bytes);
        FAIL() << "read; expected: " << reason;
    } catch (const IoError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(reason));
    }
}

void expect_near(const Eigen::Vector3f& point, float x, float y, float z) {
    EXPECT_LT((point - Eigen::Vector3f(x, y, z)).norm(), 1e-5F) << point.transpose();
}

/// Of a turn about the axis y.
std::vector<double> pose_about_y(double angle, double x = 0.0) {
    return {x, 0.0, 0.0, 0.0, std::sin(0.5 * angle), 0.0, std::cos(0.5 * angle)};
}

TEST(Rosbag, EveryPointCloud2IsAScan) {
    const auto scans = read_bag(
        test::bag_of({test::cloud_topic({test::cloud_message(3), test::cloud_message(5)})}));
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_EQ(scans[0].name, "points-1");
    const PointCloud& cloud = scans[1].cloud;
    ASSERT_EQ(cloud.size(), 10U);
    ASSERT_TRUE(cloud.grid.has_value());
    EXPECT_EQ(cloud.grid->columns, 5U);
    expect_near(cloud.positions[9], 4.0F, 1.0F, 0.5F);
    ASSERT_EQ(cloud.channels.size(), 1U);
    EXPECT_EQ(cloud.channels[0].name, "ring");
    EXPECT_EQ(cloud.channels[0].values[18], std::byte{1});
}

TEST(Rosbag, ManyCloudsAreThinnedEvenly) {
    const auto scans = read_bag(
        test::bag_of({test::cloud_topic(std::vector<std::string>(250, test::cloud_message(1)))}));
    ASSERT_EQ(scans.size(), 100U);
    EXPECT_EQ(scans.front().name, "points-1");
    EXPECT_EQ(scans.back().name, "points-249");
    EXPECT_THAT(scans[0].warnings, testing::Contains(testing::HasSubstr("100 of the 250")));
}

TEST(Rosbag, AnglesInTheMessageTurnPlanarScans) {
    test::BagTopic topic{"/slice",
                         "own/Tilted",
                         "sensor_msgs/LaserScan laser\nfloat64 stepAngle\n===\nMSG: "
                         "sensor_msgs/LaserScan\n" +
                             std::string(test::laser_definition) +
                             std::string(test::header_definition),
                         {}};
    for (const double angle : {0.0, 90.0}) {
        topic.messages.push_back(test::laser_message(1.0, "laser", {1.0F, 2.0F, 20.0F}) +
                                 test::RosBytes().add(angle).bytes());
    }
    const auto scans = read_bag(test::bag_of({topic}));
    ASSERT_EQ(scans.size(), 1U);
    const PointCloud& cloud = scans[0].cloud;
    ASSERT_EQ(cloud.size(), 6U);
    EXPECT_EQ(cloud.grid->rows, 2U);
    expect_near(cloud.positions[0], 0.0F, -1.0F, 0.0F);
    expect_near(cloud.positions[1], 2.0F, 0.0F, 0.0F);
    EXPECT_FALSE(is_finite(cloud.positions[2]));  // beyond range_max
    // Nose down: what was ahead is below.
    expect_near(cloud.positions[3], 0.0F, -1.0F, 0.0F);
    expect_near(cloud.positions[4], 0.0F, 0.0F, -2.0F);
    EXPECT_THAT(scans[0].warnings, testing::Contains(testing::HasSubstr("degrees")));
}

TEST(Rosbag, TransformsTurnPlanarScansRayByRay) {
    const double quarter = std::acos(0.0);
    // From 10 s to 12 s the unit turns by 90 degrees; it stands 5 m along x of the map.
    const auto tf = test::tf_topic({{12.0, "/base", "laser", pose_about_y(quarter)},
                                    {10.0, "/base", "laser", pose_about_y(0.0)},
                                    {0.0, "map", "base", pose_about_y(0.0, 5.0)}});
    const auto laser =
        test::laser_topic({test::laser_message(10.0, "/laser", {1.0F, 2.0F, 3.0F}),
                           test::laser_message(12.0, "laser", {1.0F, 2.0F, 3.0F}),
                           test::laser_message(10.0, "laser", {1.0F, 2.0F, 3.0F}, 2.0F / 3.0F),
                           test::laser_message(99.0, "laser", {1.0F, 2.0F, 3.0F})});
    const auto scans = read_bag(test::bag_of({tf, laser}));
    ASSERT_EQ(scans.size(), 1U);
    const PointCloud& cloud = scans[0].cloud;
    ASSERT_EQ(cloud.size(), 9U);  // of the fourth nobody knows how it lay
    expect_near(cloud.positions[1], 7.0F, 0.0F, 0.0F);
    expect_near(cloud.positions[4], 5.0F, 0.0F, -2.0F);
    // The second ray leaves after a third of the turn.
    expect_near(cloud.positions[7], 5.0F + 2.0F * static_cast<float>(std::cos(quarter / 3.0)), 0.0F,
                -2.0F * static_cast<float>(std::sin(quarter / 3.0)));
    EXPECT_THAT(scans[0].warnings, testing::Contains(testing::HasSubstr("1 of 4")));
    ASSERT_TRUE(cloud.sensor_pose.has_value());
    EXPECT_NEAR(cloud.sensor_pose->translation().x(), 5.0, 1e-6);
}

TEST(Rosbag, ReadsPackedChunks) {
    const std::vector<test::BagTopic> topics{test::cloud_topic({test::cloud_message(40)})};
    const auto bz2 = [](const std::string& chunk) {
        std::string packed(chunk.size() + 1000, '\0');
        auto size = static_cast<unsigned>(packed.size());
        std::string source = chunk;
        BZ2_bzBuffToBuffCompress(packed.data(), &size, source.data(),
                                 static_cast<unsigned>(source.size()), 9, 0, 0);
        return packed.substr(0, size);
    };
    const auto lz4 = [](const std::string& chunk) {
        std::string packed(LZ4F_compressFrameBound(chunk.size(), nullptr), '\0');
        packed.resize(
            LZ4F_compressFrame(packed.data(), packed.size(), chunk.data(), chunk.size(), nullptr));
        return packed;
    };
    const std::string plain = test::bag_of(topics);
    for (const auto& bag : {test::bag_of(topics, "bz2", bz2), test::bag_of(topics, "lz4", lz4)}) {
        EXPECT_LT(bag.size(), plain.size());
        const auto scans = read_bag(bag);
        ASSERT_EQ(scans.size(), 1U);
        EXPECT_EQ(scans[0].cloud.positions, read_bag(plain)[0].cloud.positions);
    }
    const auto no_pack = [](const std::string& chunk) { return chunk; };
    expect_refused(test::bag_of(topics, "bz2", no_pack), "bz2 chunk is damaged");
    expect_refused(test::bag_of(topics, "lz4", no_pack), "lz4 chunk is damaged");
    expect_refused(test::bag_of(topics, "zip", no_pack), "compression 'zip' is unknown");
    expect_refused(test::bag_of(topics, "lz4", [](const auto&) { return std::string("x"); }),
                   "cannot hold");
}

TEST(Rosbag, SaysWhatIsMissing) {
    expect_refused("#ROSBAG V1.2\n", "ROS 1 bag of version 2.0");
    expect_refused(test::bag_of({}), "no PointCloud2");
    const auto laser = test::laser_topic({test::laser_message(10.0, "laser", {1.0F, 2.0F})});
    expect_refused(test::bag_of({laser}), "how frame 'laser' was turned");
    const std::string whole = test::bag_of({test::cloud_topic({test::cloud_message(3)})});
    expect_refused(whole.substr(0, whole.size() - 10), "too early");
    auto short_message = test::cloud_topic({test::cloud_message(3).substr(0, 100)});
    expect_refused(test::bag_of({short_message}), "shorter than its definition");
    const test::BagTopic ring{"/a", "sensor_msgs/PointCloud2", "A a\n===\nMSG: x/A\nA a\n", {"x"}};
    expect_refused(test::bag_of({ring}), "holds itself");
    const test::BagTopic nothing{
        "/a", "sensor_msgs/PointCloud2", "A[] a\n===\nMSG: x/A\n", {"\xff\xff\xff\xff"}};
    expect_refused(test::bag_of({nothing}), "elements without fields");
}

TEST(Rosbag, ReadsTheRealTiltingHokuyo) {
    const auto path = test::real_scan("bags/tilting_hokuyo_room_240.bag");
    ROOMSCRIBE_REQUIRE_REAL_SCAN(path);
    const Scan scan = read_scan(path);
    EXPECT_EQ(scan.cloud.size(), 865U * 681U);
    ASSERT_TRUE(scan.cloud.grid.has_value());
    EXPECT_EQ(scan.cloud.grid->rows, 865U);
    // The floor is level: between 1 m and 1.5 m ahead its points lie at one height.
    std::size_t num_floor = 0;
    for (const Eigen::Vector3f& point : scan.cloud.positions) {
        if (point.x() > 1.1F && point.x() < 1.45F && std::abs(point.z() + 1.05F) < 0.04F)
            ++num_floor;
    }
    EXPECT_GT(num_floor, 1000U);
}

}  // namespace
}  // namespace roomscribe
