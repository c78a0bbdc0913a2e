// SPDX-License-Identifier: MIT
#include "roomscribe/export/labelled_points.hpp"

#include <cstring>
#include <limits>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/flat_of_two_rooms.hpp"

namespace roomscribe::test {
namespace {

template <typename Value>
Channel channel(const std::string& name, ScalarType type, const std::vector<Value>& values) {
    Channel channel{name, type, 1, {}};
    channel.values.resize(values.size() * sizeof(Value));
    std::memcpy(channel.values.data(), values.data(), channel.values.size());
    return channel;
}

struct Sample {
    Building building;
    LabelledPoints points;
};

/// Points of a wall, the drawer of the cabinet, nothing, and nothing outside; the map is shifted.
Sample sample() {
    Scene scene = flat_of_two_rooms();
    for (std::size_t i = 0; i < scene.components.size(); ++i)
        scene.components[i].instance = static_cast<std::int32_t>(10 * i);
    const auto instance_of = [&](const char* id) {
        return scene.components[*find_component(scene, id)].instance;
    };
    PointCloud map;
    map.global_shift = {100, 200, 0};
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(2, 0, 1), Eigen::Vector3d(0.5, 2.4, 0.7),
                                     Eigen::Vector3d(5, 1, 1), Eigen::Vector3d(-9, 1, 1)}) {
        map.positions.emplace_back(
            (scene.room_from_map.inverse() * p - map.global_shift).cast<float>());
    }
    map.positions.emplace_back(nan, nan, nan);
    map.channels = {
        channel<std::uint8_t>("label", ScalarType::uint8, {3, 8, 0, 0, 0}),
        channel<std::int32_t>("instance", ScalarType::int32,
                              {instance_of("wall-1"), instance_of("furniture-2"), -1, -1, -1})};
    return {describe_building(scene), labelled_points(map, scene.room_from_map)};
}

TEST(LabelledPoints, AreInTheRoomFrameWithoutFarReturns) {
    const LabelledPoints points = sample().points;
    ASSERT_EQ(points.cloud.size(), 4U);
    EXPECT_LT((points.cloud.positions[0] - Eigen::Vector3f(2, 0, 1)).norm(), 1e-4F);
    EXPECT_EQ(points.labels[1], Label::furniture);
    EXPECT_EQ(points.cloud.colors[0], label_color(Label::wall));
    EXPECT_THROW(labelled_points({}, Transform::Identity()), InvalidArgument);
}

TEST(ScannetCloud, HasIdsOfNyu40) {
    const Sample given = sample();
    const PointCloud cloud = scannet_cloud(given.points, given.building);
    ASSERT_EQ(cloud.channels.size(), 2U);
    std::vector<std::uint16_t> labels(4);
    std::vector<std::uint16_t> instances(4);
    std::memcpy(labels.data(), cloud.channels[0].values.data(), 8);
    std::memcpy(instances.data(), cloud.channels[1].values.data(), 8);
    // A wall, the drawer of a cabinet, nothing.
    EXPECT_EQ(labels, (std::vector<std::uint16_t>{1, 3, 0, 0}));
    EXPECT_GT(instances[0], 0);
    EXPECT_GT(instances[1], 0);
    EXPECT_NE(instances[0], instances[1]);
    EXPECT_EQ(instances[2], 0);
}

TEST(S3disFiles, HoldEveryPointInItsRoomAndInItsThing) {
    const Sample given = sample();
    std::map<std::string, std::vector<std::uint32_t>> files;
    for (const S3disFile& file : s3dis_files(given.points, given.building))
        files[file.path] = file.points;
    using Points = std::vector<std::uint32_t>;
    const std::map<std::string, Points> wanted{
        {"room-1/room-1.txt", {0, 1}},
        {"room-2/room-2.txt", {2}},
        {"room_0/room_0.txt", {3}},
        {"room-1/Annotations/wall_1.txt", {0}},
        {"room-1/Annotations/clutter_1.txt", {1}},
        {"room-2/Annotations/clutter_1.txt", {2}},
        {"room_0/Annotations/clutter_1.txt", {3}},
    };
    EXPECT_EQ(files, wanted);
    PointCloud cloud;
    cloud.positions = {{1.0F, -2.5F, 0.25F}};
    cloud.colors = {{1, 2, 255}};
    EXPECT_EQ(s3dis_text(cloud, std::vector<std::uint32_t>{0}), "1.0000 -2.5000 0.2500 1 2 255\n");
}

TEST(ClassNames, FollowLabelAndKind) {
    EXPECT_EQ(nyu40_id(Label::furniture, "sofa"), 6);
    EXPECT_EQ(nyu40_id(Label::furniture, "piano"), 39);
    EXPECT_EQ(nyu40_id(Label::handle, "knob"), 40);
    EXPECT_EQ(s3dis_class(Label::furniture, "shelf"), "bookcase");
    EXPECT_EQ(s3dis_class(Label::door_frame, ""), "door");
    EXPECT_EQ(s3dis_class(Label::handle, ""), "clutter");
}

}  // namespace
}  // namespace roomscribe::test
