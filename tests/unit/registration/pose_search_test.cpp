// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/registration/pair/pose_screening.hpp"
#include "roomscribe/registration/pair/pose_support.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

constexpr double coarseness = 5.0;  // of 0.15 degrees

/// An L-shaped room from two places, the second scan turned about all axes.
struct TwoScans {
    RegistrationScale scale{
        .coarse_voxel = 0.1, .fine_voxel = 0.04, .fpfh_radius = 0.5, .noise = 0.002};
    Transform target_from_source = Transform::Identity();
    PreparedScan target;
    PreparedScan source;

    TwoScans() : TwoScans(place(1.5, 1.5, 0.0), place(3.5, 1.4, 2.0)) {}

  private:
    static Transform place(double x, double y, double turn) {
        Transform pose = Transform::Identity();
        pose.translation() = Eigen::Vector3d(x, y, 1.5);
        pose.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d(0.3, -0.5, 0.8).normalized())
                            .toRotationMatrix();
        return pose;
    }
    TwoScans(const Transform& first, const Transform& second)
        : target_from_source(first.inverse() * second),
          target(prepare_scan(test::simulate_scan(test::l_shaped_room(), first, 1, coarseness),
                              scale)),
          source(prepare_scan(test::simulate_scan(test::l_shaped_room(), second, 2, coarseness),
                              scale)) {}
};

TEST(SurfaceDirections, AreThoseOfABox) {
    Random random(3);
    std::vector<Eigen::Vector3f> normals;
    const auto add = [&](const Eigen::Vector3d& direction, int count) {
        for (int i = 0; i < count; ++i) {
            const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
            normals.push_back((direction + 0.03 * noise).normalized().cast<float>());
        }
    };
    add(Eigen::Vector3d::UnitZ(), 500);
    add(-Eigen::Vector3d::UnitX(), 300);
    add(Eigen::Vector3d(0.6, 0.8, 0.0), 190);
    add(-Eigen::Vector3d::UnitZ(), 10);
    normals.emplace_back(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    const std::vector<SurfaceDirection> found = find_surface_directions(normals);
    ASSERT_EQ(found.size(), 3U);  // a hundredth is too little
    EXPECT_GT(found[0].direction.z(), std::cos(radians(1.0)));
    EXPECT_LT(found[1].direction.x(), -std::cos(radians(1.0)));
    EXPECT_GT(found[2].direction.dot(Eigen::Vector3d(0.6, 0.8, 0.0)), std::cos(radians(1.0)));
    EXPECT_NEAR(found[0].share, 0.5, 0.01);
    EXPECT_TRUE(find_surface_directions({}).empty());
    EXPECT_TRUE(faces_three_ways(found));
    EXPECT_FALSE(faces_three_ways(std::span(found).first(2)));
}

TEST(SurfaceDirections, WallsThatLookAtEachOtherFixOneShift) {
    const std::vector<SurfaceDirection> across{{Eigen::Vector3d::UnitZ(), 0.4},
                                               {Eigen::Vector3d::UnitX(), 0.3},
                                               {Eigen::Vector3d::UnitY(), 0.03},
                                               {-Eigen::Vector3d::UnitY(), 0.03}};
    EXPECT_TRUE(faces_three_ways(across));
    EXPECT_FALSE(faces_three_ways(std::span(across).first(3)));
}

TEST(SurfaceGrid, FindsAPointWhereverOneIsNear) {
    Random random(5);
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 500; ++i) {
        points.emplace_back(static_cast<float>(random.uniform(-2.0, 2.0)),
                            static_cast<float>(random.uniform(-2.0, 2.0)),
                            static_cast<float>(random.uniform(-0.5, 0.5)));
    }
    constexpr double cell = 0.2;
    const SurfaceGrid grid(points, cell);
    const auto cell_of = [&](const Eigen::Vector3f& place) {
        return Eigen::Vector3i((place / static_cast<float>(cell)).array().floor().cast<int>());
    };
    int num_found = 0;
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector3f place(static_cast<float>(random.uniform(-2.5, 2.5)),
                                    static_cast<float>(random.uniform(-2.5, 2.5)),
                                    static_cast<float>(random.uniform(-1.0, 1.0)));
        const auto is_near = [&](const Eigen::Vector3f& point) {
            return (cell_of(point) - cell_of(place)).cwiseAbs().maxCoeff() <= 1;
        };
        const auto found = grid.near(place);
        ASSERT_EQ(found.has_value(), std::any_of(points.begin(), points.end(), is_near));
        if (!found) continue;
        ++num_found;
        EXPECT_TRUE(is_near(points[*found]));
    }
    EXPECT_GT(num_found, 200);
}

TEST(SearchPoses, ListsTheRightOneAndScreeningPutsItFirst) {
    const TwoScans scans;
    const std::vector<Transform> poses = search_poses(scans.source, scans.target, scans.scale);
    const auto off_by = [&](const Transform& pose) {
        return rms_displacement(scans.source.spread, pose, scans.target_from_source);
    };
    ASSERT_FALSE(poses.empty());
    const std::vector<double> scores =
        screen_poses(scans.source, scans.target, poses, scans.scale, {});
    const auto best = std::max_element(scores.begin(), scores.end()) - scores.begin();
    EXPECT_LT(off_by(poses[static_cast<std::size_t>(best)]), 2.0 * scans.scale.coarse_voxel);
}

TEST(SearchPoses, ListsNothingForOneWall) {
    Scan wall;
    for (int i = 0; i < 60; ++i) {
        for (int j = 0; j < 40; ++j) {
            wall.cloud.positions.emplace_back(2.0F, 0.05F * static_cast<float>(i),
                                              0.05F * static_cast<float>(j));
        }
    }
    const RegistrationScale scale;
    const PreparedScan scan = prepare_scan(wall, scale);
    EXPECT_TRUE(search_poses(scan, scan, scale).empty());
}

TEST(MeasureSupport, DetailsTellTheRightPoseFromOneThatTheShellLikesToo) {
    const TwoScans scans;
    const SupportTolerance tolerance = fine_tolerance(scans.scale);
    const PoseSupport right =
        measure_support(scans.source, scans.target, scans.target_from_source, tolerance);
    ASSERT_TRUE(right.free_space_is_known);
    EXPECT_LT(right.all().contradicted_share(), 0.015);
    EXPECT_GT(10 * right.detail.pieces.confirmed, 8 * right.detail.pieces.judged());
    EXPECT_GT(right.overlap(), 0.3);

    // Half a metre along a wall: floor, ceiling and two walls stay where they are.
    Transform slid = scans.target_from_source;
    slid.translation().x() += 0.5;
    const PoseSupport wrong = measure_support(scans.source, scans.target, slid, tolerance);
    EXPECT_GT(wrong.overlap(), 0.2);
    EXPECT_GT(wrong.all().contradicted_share(), 0.03);
    EXPECT_LT(2 * wrong.detail.pieces.confirmed, wrong.detail.pieces.judged());
    EXPECT_GT(right.evidence(), 15.0);
    EXPECT_LT(wrong.evidence(), 0.0);

    // Either scan may be the judge.
    const PoseSupport reversed =
        measure_support(scans.target, scans.source, scans.target_from_source.inverse(), tolerance);
    EXPECT_EQ(reversed.all().confirmed, right.all().confirmed);
    EXPECT_EQ(reversed.all().contradicted, right.all().contradicted);
    EXPECT_EQ(reversed.evidence(), right.evidence());
}

}  // namespace
}  // namespace roomscribe
