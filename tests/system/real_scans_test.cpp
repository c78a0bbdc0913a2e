// SPDX-License-Identifier: MIT
// Scans that others recorded. They are not part of the project: tests skip where they are absent.
#include <array>

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
