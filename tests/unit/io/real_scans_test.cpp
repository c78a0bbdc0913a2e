// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

TEST(RealScans, EveryFileIsRead) {
    const auto data = test::real_scan("");
    ROOMSCRIBE_REQUIRE_REAL_SCAN(data);
    std::map<std::string, std::size_t> num_read;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".pcd" && extension != ".ply" && extension != ".3d" &&
            extension != ".vtk") {
            continue;
        }
        SCOPED_TRACE(entry.path());
        const FileSummary summary = summarize_file(entry.path()).front();
        EXPECT_GT(summary.num_points, 1000U);
        EXPECT_FALSE(summary.bounds.isEmpty());
        EXPECT_TRUE(summary.warnings.empty());
        ++num_read[extension];
    }
    EXPECT_GT(num_read[".pcd"], 30U);
    EXPECT_GT(num_read[".ply"], 150U);
    EXPECT_EQ(num_read[".3d"], 3U);
    EXPECT_EQ(num_read[".vtk"], 2U);
}

TEST(RealScans, PointCountsAreThoseOfTheirDescription) {
    const std::map<std::string, std::size_t> expected = {
        {"registration/pcl_room_scan/room_scan1.pcd", 112586},
        {"registration/pcl_room_scan/room_scan2.pcd", 112624},
        {"registration/3dtk_dat/scan000.3d", 81360},
        {"registration/libpointmatcher_apartment/cloud_0.vtk", 36674},
        {"registration/libpointmatcher_apartment/cloud_1.vtk", 36670},
        {"rooms/s3dis/Area_3_hallway_3.ply", 175075},
        {"rooms/loadersgl_indoor/indoor.ply", 808042}};
    for (const auto& [path, num_points] : expected) {
        const auto file = test::real_scan(path);
        ROOMSCRIBE_REQUIRE_REAL_SCAN(file);
        EXPECT_EQ(read_scan(file).cloud.size(), num_points) << path;
    }
}

TEST(RealScans, OrganisedFramesHaveGridAndPose) {
    const auto file = test::real_scan("rgbd/pcl_office1/office1.pcd");
    ROOMSCRIBE_REQUIRE_REAL_SCAN(file);
    const PointCloud cloud = read_scan(file).cloud;
    ASSERT_TRUE(cloud.grid);
    EXPECT_EQ(cloud.grid->rows, 480U);
    EXPECT_EQ(cloud.grid->columns, 640U);
    EXPECT_TRUE(cloud.sensor_pose);
    EXPECT_EQ(cloud.colors.size(), cloud.size());
}

/// Every n-th point from 1 m to 15 m away, placed: what is nearer or farther is noise here.
std::vector<Eigen::Vector3f> placed(const PointCloud& cloud, const Transform& pose,
                                    std::size_t step) {
    std::vector<Eigen::Vector3f> points;
    for (std::size_t i = 0; i < cloud.size(); i += step) {
        const float range = cloud.positions[i].norm();
        if (range < 1.0F || range > 15.0F) continue;
        points.push_back((pose * cloud.positions[i].cast<double>()).cast<float>());
    }
    return points;
}

/// How far three quarters of the points of one scan are from the other at most.
double gap_between(const SearchTree& tree, const std::vector<Eigen::Vector3f>& target,
                   const std::vector<Eigen::Vector3f>& points) {
    std::vector<double> gaps;
    for (const Eigen::Vector3f& point : points) {
        const Eigen::Vector3f nearest = target[tree.nearest(point).index];
        gaps.push_back(static_cast<double>((nearest - point).norm()));
    }
    const auto upper_quartile = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() * 3 / 4);
    std::nth_element(gaps.begin(), upper_quartile, gaps.end());
    return *upper_quartile;
}

Transform with_rotation_undone(Transform pose) {
    pose.linear().transposeInPlace();
    return pose;
}

/// Points and poses must be turned over alike, and the angles have the right sign.
TEST(RealScans, PosesOf3dtkBringItsScansTogether) {
    std::vector<PointCloud> scans;
    std::vector<Transform> poses;
    for (const std::string name : {"scan000", "scan001", "scan002"}) {
        const auto file = test::real_scan("registration/3dtk_dat/" + name + ".3d");
        ROOMSCRIBE_REQUIRE_REAL_SCAN(file);
        scans.push_back(read_scan(file).cloud);
        auto pose_file = file;
        poses.push_back(read_poses(pose_file.replace_extension(".pose")).at(0).value());
    }
    for (std::size_t i = 1; i < scans.size(); ++i) {
        const auto target = placed(scans[i - 1], poses[i - 1], 1);
        const SearchTree tree(target);
        const auto gap = [&](const Transform& pose) {
            return gap_between(tree, target, placed(scans[i], pose, 5));
        };
        EXPECT_LT(gap(poses[i]), 0.08);
        EXPECT_LT(gap(poses[i]), 0.5 * gap(poses[i - 1]));
        EXPECT_LT(gap(poses[i]), 0.9 * gap(with_rotation_undone(poses[i])));
    }
    // Scan 1 stands 1.57 m ahead of scan 0.
    EXPECT_NEAR(poses[1].translation().x(), 1.569, 0.001);
}

}  // namespace
}  // namespace roomscribe
