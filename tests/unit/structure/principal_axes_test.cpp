// SPDX-License-Identifier: MIT
#include "roomscribe/structure/principal_axes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Points evenly at random on the six faces of a box of 5 x 4 x 2.5 m, turned.
PointCloud box_cloud(std::size_t count, const Eigen::Matrix3d& rotation, double noise) {
    const Eigen::Vector3d size(5.0, 4.0, 2.5);
    Random random(11);
    PointCloud cloud;
    for (std::size_t i = 0; i < count; ++i) {
        Eigen::Vector3d point(random.uniform() * size.x(), random.uniform() * size.y(),
                              random.uniform() * size.z());
        // Floor and ceiling are the largest faces, then the long walls, then the short ones.
        const double pick = random.uniform();
        const int axis = pick < 0.47 ? 2 : pick < 0.77 ? 1 : 0;
        point[axis] = (random.below(2) == 0 ? 0.0 : size[axis]) + noise * random.normal();
        cloud.positions.push_back((rotation * point).cast<float>());
    }
    return cloud;
}

PlanarPatch patch_of(const Eigen::Vector3d& normal, double area) {
    PlanarPatch patch;
    patch.plane.normal = normal.normalized();
    patch.area = area;
    return patch;
}

/// Largest angle from a column of `axes` to the nearest direction of `truth`.
double axes_error(const Eigen::Matrix3d& axes, const Eigen::Matrix3d& truth) {
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double cosine = (truth.transpose() * axes.col(i)).cwiseAbs().maxCoeff();
        worst = std::max(worst, std::acos(std::min(cosine, 1.0)));
    }
    return degrees(worst);
}

const Eigen::Matrix3d turned =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();

TEST(DetectPlanesRansac, TakesOutTheSixFacesOfABox) {
    PointCloud cloud = box_cloud(40'000, turned, 0.005);
    cloud.positions[5].x() = std::numeric_limits<float>::quiet_NaN();
    const PlaneDetectionResult result = detect_planes_ransac(cloud, 1);
    ASSERT_EQ(result.planes.size(), 6U);
    EXPECT_EQ(result.stop, PlaneDetectionStop::few_points_left);
    std::size_t covered = result.remaining_points.size();
    for (const PlanarPatch& plane : result.planes) {
        covered += plane.points.size();
        EXPECT_GE(plane.points.size(), 2500U);
        EXPECT_LT(plane.rms, 0.012);
        EXPECT_LT(degrees(std::acos(std::min(
                      1.0, (turned.transpose() * plane.plane.normal).cwiseAbs().maxCoeff()))),
                  0.5);
    }
    EXPECT_EQ(covered, cloud.size() - 1);
    EXPECT_GE(result.planes.front().points.size(), result.planes.back().points.size());
}

TEST(DetectPlanesRansac, StopsWhenTheBestPlaneIsTooSmall) {
    Random random(4);
    PointCloud cloud;
    for (int i = 0; i < 5000; ++i) {
        cloud.positions.emplace_back(static_cast<float>(random.uniform()),
                                     static_cast<float>(random.uniform()),
                                     static_cast<float>(random.uniform()));
    }
    const PlaneDetectionResult result = detect_planes_ransac(cloud, 1);
    EXPECT_TRUE(result.planes.empty());
    EXPECT_EQ(result.stop, PlaneDetectionStop::few_inliers_left);
    EXPECT_EQ(result.remaining_points.size(), 5000U);
    EXPECT_EQ(detect_planes_ransac({}, 1).stop, PlaneDetectionStop::few_points_left);
}

TEST(EstimatePrincipalAxesPaper, FindsTheAxesOfABoxInAnyPose) {
    const PrincipalAxes axes = estimate_principal_axes_paper(box_cloud(40'000, turned, 0.005), 3);
    EXPECT_EQ(axes.stop, PrincipalAxesStop::three_planes);
    EXPECT_LT(axes_error(axes.axes, turned), 0.3);
    EXPECT_NEAR(axes.axes.determinant(), 1.0, 1e-9);
    EXPECT_NEAR(axes.score, 1.0, 1e-9);
}

TEST(EstimatePrincipalAxesPaper, CompletesTwoPlanesByTheirCrossProduct) {
    Random random(9);
    PointCloud cloud;
    for (int i = 0; i < 8000; ++i) {
        const auto a = static_cast<float>(random.uniform() * 3.0);
        const auto b = static_cast<float>(random.uniform() * 3.0);
        cloud.positions.push_back(i % 8 < 5 ? Eigen::Vector3f(a, b, 0) : Eigen::Vector3f(a, 0, b));
    }
    const PrincipalAxes axes = estimate_principal_axes_paper(cloud, 1);
    EXPECT_EQ(axes.stop, PrincipalAxesStop::two_planes);
    EXPECT_LT(axes_error(axes.axes, Eigen::Matrix3d::Identity()), 0.3);
    cloud.positions.resize(100);
    EXPECT_EQ(estimate_principal_axes_paper(cloud, 1).stop, PrincipalAxesStop::no_plane);
}

TEST(EstimatePrincipalAxes, WeighsByAreaAndNamesTheRunnerUp) {
    const Eigen::Matrix3d wing =
        turned * Eigen::AngleAxisd(radians(30.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const std::vector<PlanarPatch> patches{
        patch_of(turned.col(2), 20.0), patch_of(turned.col(0), 10.0), patch_of(-turned.col(1), 8.0),
        patch_of(wing.col(0), 6.0), patch_of(wing.col(1), 5.0)};
    const PrincipalAxes axes = estimate_principal_axes(patches);
    EXPECT_EQ(axes.stop, PrincipalAxesStop::three_planes);
    EXPECT_LT(axes_error(axes.axes, turned), 1e-4);
    EXPECT_NEAR(axes.score, 38.0 / 49.0, 1e-9);
    EXPECT_NEAR(axes.runner_up_score, 31.0 / 49.0, 1e-9);
    EXPECT_LT(axes_error(axes.runner_up_axes, wing), 1e-4);
}

TEST(EstimatePrincipalAxes, SaysWhenThereIsTooLittle) {
    EXPECT_EQ(estimate_principal_axes({}).stop, PrincipalAxesStop::no_plane);
    const std::vector<PlanarPatch> one{patch_of({1, 1, 0}, 2.0)};
    const PrincipalAxes axes = estimate_principal_axes(one);
    EXPECT_EQ(axes.stop, PrincipalAxesStop::one_plane);
    EXPECT_NEAR(std::abs(axes.axes.col(0).dot(one[0].plane.normal)), 1.0, 1e-12);
    EXPECT_TRUE((axes.axes.transpose() * axes.axes).isIdentity(1e-12));
}

}  // namespace
}  // namespace roomscribe
