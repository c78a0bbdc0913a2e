// SPDX-License-Identifier: MIT
// Scans that others recorded. They are not part of the project: tests skip where they are absent.
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

std::vector<std::string> room_scans() {
    std::vector<std::string> paths;
    for (const char* name : {"room_scan1.pcd", "room_scan2.pcd"}) {
        const auto path = real_scan(std::string("registration/pcl_room_scan/") + name);
        if (!path.empty()) paths.push_back(path.string());
    }
    return paths;
}

/// Second scan -> first scan, by a fine ICP; good to about 1.5 cm and 0.3 degrees.
Transform room_scan_reference() {
    Transform pose = Transform::Identity();
    Eigen::Matrix3d rotation;
    rotation << .7570, -.6528, .0280, .6527, .7575, .0131, -.0298, .0084, .9995;
    pose.linear() = nearest_rotation(rotation);
    pose.translation() << 1.971, .057, .025;
    return pose;
}

Transform random_rotation(std::uint64_t seed) {
    Random random(seed);
    Transform rotation = Transform::Identity();
    rotation.linear() =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
            .normalized()
            .toRotationMatrix();
    return rotation;
}

void expect_near_reference(const std::filesystem::path& poses_file, const Transform& reference) {
    const auto poses = read_poses(poses_file);
    ASSERT_EQ(poses.size(), 2U);
    ASSERT_TRUE(poses[0] && poses[1]);
    const Transform error = reference.inverse() * poses[0]->inverse() * *poses[1];
    EXPECT_LT(degrees(rotation_angle(error.linear())), 0.5);
    EXPECT_LT(error.translation().norm(), 0.05);
}

/// The truth of its poses is that of depth fusion, and bends by 9 cm and 3 degrees over these
/// frames against what their surfaces say.
TEST(RealDepthFrames, OfAKitchenArePlacedWithoutTheirPoses) {
    const std::filesystem::path kitchen = real_scan("rgbd/7scenes_redkitchen");
    ROOMSCRIBE_REQUIRE_REAL_SCAN(kitchen);
    const TemporaryFolder folder;
    const std::filesystem::path frames = folder / "frames";
    const std::filesystem::path out = folder / "out";
    std::filesystem::create_directory(frames);
    std::filesystem::copy(kitchen / "camera-intrinsics.txt", frames);
    std::vector<Transform> truth;
    for (int number = 0; number <= 225; number += 25) {
        const std::string name = fmt::format("frame-{:06}", number);
        std::filesystem::copy(kitchen / (name + ".depth.png"), frames);
        truth.push_back(*read_poses(kitchen / (name + ".pose.txt")).at(0));
    }
    ASSERT_EQ(roomscribe({"register", frames.string(), "-o", out.string()}).exit_code, 0);
    const auto poses = read_poses(out / "poses.txt");
    ASSERT_EQ(poses.size(), truth.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        ASSERT_TRUE(poses[i]) << i;
        const Transform found = poses[0]->inverse() * *poses[i];
        const Transform error = (truth[0].inverse() * truth[i]).inverse() * found;
        EXPECT_LT(error.translation().norm(), 0.12) << i;
        EXPECT_LT(degrees(rotation_angle(error.linear())), 4.0) << i;
    }
}

TEST(RealRoomScans, RunFindsThePoseAndTheRoom) {
    const std::vector<std::string> scans = room_scans();
    if (scans.size() != 2) GTEST_SKIP() << "the folder of real scans is absent";
    const TemporaryFolder folder;
    for (const char* seed : {"1", "2"}) {
        const std::filesystem::path out = folder / (std::string("seed") + seed);
        const ProgramResult result =
            roomscribe({"run", scans[0], scans[1], "-o", out.string(), "--seed", seed});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        expect_near_reference(out / "poses.txt", room_scan_reference());
        const nlohmann::json scene = read_json(out / "scene.json");
        EXPECT_GE(count_components(scene, "floor"), 1U);
        EXPECT_GE(count_components(scene, "ceiling"), 1U);
        EXPECT_GE(count_components(scene, "wall"), 3U);
    }
}

TEST(RealRoomScans, AnyRotationOfTheScansGivesTheSamePose) {
    const std::vector<std::string> scans = room_scans();
    if (scans.size() != 2) GTEST_SKIP() << "the folder of real scans is absent";
    const TemporaryFolder folder;
    const std::array<Transform, 2> turned{random_rotation(11), random_rotation(12)};
    std::vector<std::string> arguments{"register"};
    for (std::size_t i = 0; i < 2; ++i) {
        Scan scan = read_scan(scans[i]);
        transform_in_place(scan.cloud, turned[i]);
        arguments.push_back((folder / fmt::format("turned{}.pcd", i)).string());
        write_point_cloud(arguments.back(), scan.cloud);
    }
    const std::filesystem::path out = folder / "out";
    arguments.insert(arguments.end(), {"-o", out.string()});
    ASSERT_EQ(roomscribe(arguments).exit_code, 0);
    expect_near_reference(out / "poses.txt",
                          turned[0] * room_scan_reference() * turned[1].inverse());
}

struct RealJob {
    std::string test_name;
    std::string verb;
    std::vector<std::string> scans;
};

void PrintTo(const RealJob& job, std::ostream* stream) {
    *stream << job.test_name;
}

class RealScans : public testing::TestWithParam<RealJob> {};

TEST_P(RealScans, RunWithoutACrash) {
    const TemporaryFolder folder;
    std::vector<std::string> arguments{GetParam().verb};
    for (const std::string& name : GetParam().scans) {
        const std::filesystem::path path = real_scan(name);
        ROOMSCRIBE_REQUIRE_REAL_SCAN(path);
        arguments.push_back(path.string());
    }
    arguments.insert(arguments.end(), {"-o", (folder / "out").string(), "--json"});
    const ProgramResult result = roomscribe(arguments);
    EXPECT_FALSE(result.timed_out);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 4) << result.err;
    EXPECT_TRUE(nlohmann::json::accept(result.out)) << result.out;
    EXPECT_GT(read_bytes(folder / "out" / "report.html").size(), 0U);
}

/// What is known of a cloud's room, to be found with margin.
struct RealRoom {
    std::string test_name;
    std::string scan;
    std::size_t min_ceilings;
    std::size_t min_walls;
    std::size_t max_walls;
    Eigen::Vector3d up;  ///< in the file's frame, if known: else zero
};

void PrintTo(const RealRoom& room, std::ostream* stream) {
    *stream << room.test_name;
}

class RealRooms : public testing::TestWithParam<RealRoom> {};

TEST_P(RealRooms, FloorCeilingWallsAndUpAreFound) {
    const RealRoom& room = GetParam();
    const std::filesystem::path path = real_scan(room.scan);
    ROOMSCRIBE_REQUIRE_REAL_SCAN(path);
    const TemporaryFolder folder;
    const std::filesystem::path out = folder / "out";
    ASSERT_EQ(roomscribe({"interpret", path.string(), "-o", out.string()}).exit_code, 0);
    const nlohmann::json scene = read_json(out / "scene.json");
    EXPECT_GE(count_components(scene, "floor"), 1U);
    EXPECT_GE(count_components(scene, "ceiling"), room.min_ceilings);
    EXPECT_GE(count_components(scene, "wall"), room.min_walls);
    EXPECT_LE(count_components(scene, "wall"), room.max_walls);
    const nlohmann::json& row = scene["to_room"][2];
    const Eigen::Vector3d up(row[0], row[1], row[2]);
    if (!room.up.isZero()) {
        EXPECT_GT(up.dot(room.up), std::cos(radians(3.0)));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Clouds, RealRooms,
    testing::Values(
        // The scanner was tilted by an unknown angle.
        // Two pieces of its back wall, which lean differently in the scan, are one wall.
        RealRoom{"Office", "rooms/3dsmart_dlut/A601.pcd", 1, 4, 12, Eigen::Vector3d::Zero()},
        // Furniture before the scanner hides nearly all of the floor.
        RealRoom{"HiddenFloor", "rooms/3dsmart_dlut/A603.pcd", 1, 4, 12, Eigen::Vector3d::Zero()},
        RealRoom{"Laboratory", "rooms/3dsmart_dlut/A605.pcd", 1, 4, 15, Eigen::Vector3d::Zero()},
        // The laser stood 0.86 m above the origin.
        RealRoom{"Piers", "rooms/3dsmart_dlut/A619.pcd", 1, 4, 12, Eigen::Vector3d::Zero()},
        // Its back wall leans by 12 degrees in the scan.
        RealRoom{"BentWalls", "rooms/3dsmart_dlut/A617.pcd", 1, 2, 15, Eigen::Vector3d::Zero()},
        RealRoom{"Studio", "rooms/scannet_scene0000/scene0000_00_labels.ply", 1, 8, 35,
                 Eigen::Vector3d::UnitZ()},
        RealRoom{"MeetingRoom", "rooms/scannet_unlabelled/scene0005_01.ply", 0, 3, 15,
                 Eigen::Vector3d::UnitZ()},
        RealRoom{"Hallway", "rooms/s3dis/Area_3_hallway_3.ply", 1, 2, 15, Eigen::Vector3d::UnitZ()},
        // About 20 rooms, each with a face of its own per wall. Walls and ground were seen through
        // its windows, up to 80 m away.
        RealRoom{"HallAndOffices", "rooms/cv4aec_10cm/sample2.ply", 1, 60, 130,
                 Eigen::Vector3d::UnitZ()},
        RealRoom{"Floor", "rooms/cv4aec_10cm/sample3.ply", 1, 60, 150, Eigen::Vector3d::UnitZ()},
        RealRoom{"TwoStoreys", "rooms/loadersgl_indoor/indoor.ply", 2, 20, 80,
                 Eigen::Vector3d::UnitY()}),
    [](const auto& tested) { return tested.param.test_name; });

/// Of the labelled points, by the numbers that the data set gives them.
struct RealLabels {
    std::string test_name;
    std::string scan;
    int unlabelled;
    std::array<int, 3> truth;         ///< floor, ceiling, wall
    std::array<double, 3> least_iou;  ///< a little less than measured
};

void PrintTo(const RealLabels& labels, std::ostream* stream) {
    *stream << labels.test_name;
}

class RealLabelledRooms : public testing::TestWithParam<RealLabels> {};

std::vector<int> channel(const PointCloud& cloud, const std::string& name) {
    std::vector<int> values;
    for (const Channel& one : cloud.channels) {
        if (one.name != name) continue;
        const std::size_t size = one.bytes_per_point();
        for (std::size_t i = 0; i < cloud.size(); ++i)
            values.push_back(std::to_integer<int>(one.values[i * size]));
    }
    return values;
}

TEST_P(RealLabelledRooms, PointLabelsAgree) {
    const RealLabels& labels = GetParam();
    const std::filesystem::path path = real_scan(labels.scan);
    ROOMSCRIBE_REQUIRE_REAL_SCAN(path);
    const TemporaryFolder folder;
    const std::filesystem::path out = folder / "out";
    ASSERT_EQ(roomscribe({"interpret", path.string(), "-o", out.string()}).exit_code, 0);
    const PointCloud cloud = read_scan(out / "labels.ply").cloud;
    const std::vector<int> truth = channel(cloud, "input_label");
    const std::vector<int> found = channel(cloud, "label");
    ASSERT_EQ(truth.size(), cloud.size());
    ASSERT_EQ(found.size(), cloud.size());
    for (std::size_t k = 0; k < 3; ++k) {
        std::size_t both = 0;
        std::size_t either = 0;
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            if (truth[i] == labels.unlabelled) continue;
            const bool is_true = truth[i] == labels.truth[k];
            const bool is_found = found[i] == static_cast<int>(k) + 1;
            both += is_true && is_found ? 1 : 0;
            either += is_true || is_found ? 1 : 0;
        }
        EXPECT_GE(static_cast<double>(both), labels.least_iou[k] * static_cast<double>(either))
            << k << ": " << static_cast<double>(both) / static_cast<double>(either);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Clouds, RealLabelledRooms,
    testing::Values(
        // Its doors, which include their frames, count as wall until they are told apart.
        RealLabels{"Hallway", "rooms/s3dis/Area_3_hallway_3.ply", -1, {1, 0, 2}, {.97, .96, .64}},
        RealLabels{"Studio00",
                   "rooms/scannet_scene0000/scene0000_00_labels.ply",
                   0,
                   {2, 22, 1},
                   {.77, .87, .5}},
        RealLabels{"Studio01",
                   "rooms/scannet_scene0000/scene0000_01_labels.ply",
                   0,
                   {2, 22, 1},
                   {.77, .7, .34}},
        RealLabels{"Studio02",
                   "rooms/scannet_scene0000/scene0000_02_labels.ply",
                   0,
                   {2, 22, 1},
                   {.77, .87, .39}}),
    [](const auto& tested) { return tested.param.test_name; });

INSTANTIATE_TEST_SUITE_P(
    Clouds, RealScans,
    testing::Values(
        RealJob{"Uos",
                "register",
                {"registration/3dtk_dat/scan000.3d", "registration/3dtk_dat/scan001.3d"}},
        RealJob{"Apartment",
                "register",
                {"registration/libpointmatcher_apartment/cloud_0.vtk",
                 "registration/libpointmatcher_apartment/cloud_1.vtk"}},
        RealJob{"TableTop",
                "register",
                {"registration/pcl_pairwise/capture0001.pcd",
                 "registration/pcl_pairwise/capture0002.pcd"}},
        RealJob{"Kitchen",
                "register",
                {"registration/3dmatch/7-scenes-redkitchen/cloud_bin_0.ply",
                 "registration/3dmatch/7-scenes-redkitchen/cloud_bin_1.ply"}},
        RealJob{"OfficeTwice",
                "register",
                {"rooms/3dsmart_dlut/A603.pcd", "rooms/3dsmart_dlut/query_01.pcd"}},
        RealJob{"Office", "interpret", {"rooms/3dsmart_dlut/A601.pcd"}},
        RealJob{"Laboratory", "interpret", {"rooms/3dsmart_dlut/A605.pcd"}},
        RealJob{"Studio", "interpret", {"rooms/scannet_scene0000/scene0000_00_labels.ply"}},
        RealJob{"MeetingRoom", "interpret", {"rooms/scannet_unlabelled/scene0005_01.ply"}},
        RealJob{"Hallway", "interpret", {"rooms/s3dis/Area_3_hallway_3.ply"}},
        RealJob{"HallAndOffices", "interpret", {"rooms/cv4aec_10cm/sample2.ply"}},
        RealJob{"Floor", "interpret", {"rooms/cv4aec_10cm/sample3.ply"}},
        RealJob{"TwoStoreys", "interpret", {"rooms/loadersgl_indoor/indoor.ply"}},
        RealJob{"DoorAndCupboards", "interpret", {"rgbd/pcl_office1/office1.pcd"}}),
    [](const auto& tested) { return tested.param.test_name; });

}  // namespace
}  // namespace roomscribe::test
