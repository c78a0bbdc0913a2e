// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_slides.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Twist = Eigen::Matrix<double, 6, 1>;

constexpr double distance = 0.2;
constexpr std::array<double, 4> distances{2.0 * distance, distance, distance, 2.0 * distance};

PointSpread spread() {
    return {{1.0, -0.5, 0.2}, Eigen::Vector3d(2.0, 1.0, 0.3).asDiagonal()};
}

Transform pose() {
    Transform pose = Transform::Identity();
    pose.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(3.0, 1.0, 0.1);
    return pose;
}

TEST(SlidePose, MovesAlongTheAxisBothWays) {
    Twist axis = Twist::Zero();
    axis[3] = 1.0;
    const std::vector<Transform> slid = slide_pose(spread(), pose(), std::array{axis}, distance);
    ASSERT_EQ(slid.size(), distances.size());
    for (std::size_t i = 0; i < slid.size(); ++i) {
        const Eigen::Vector3d step = slid[i].translation() - pose().translation();
        EXPECT_NEAR(step.x(), (i < 2 ? -1.0 : 1.0) * distances[i], 1e-6);
        EXPECT_NEAR(step.tail<2>().norm(), 0.0, 1e-9);
    }
}

TEST(SlidePose, MovesPointsByTheDistanceWhereItTurns) {
    Twist turn = Twist::Zero();
    turn.head<3>() = Eigen::Vector3d(0.0, 0.6, 0.8);
    const std::vector<Transform> slid = slide_pose(spread(), pose(), std::array{turn}, distance);
    ASSERT_EQ(slid.size(), distances.size());
    for (std::size_t i = 0; i < slid.size(); ++i)
        EXPECT_NEAR(rms_displacement(spread(), pose(), slid[i]), distances[i], 0.01 * distance);
}

TEST(SlidePose, LeavesOutWhatMovesNothing) {
    EXPECT_TRUE(slide_pose(spread(), pose(), {}, distance).empty());
    EXPECT_TRUE(slide_pose(spread(), pose(), std::array{Twist(Twist::Zero())}, distance).empty());
}

}  // namespace
}  // namespace roomscribe
