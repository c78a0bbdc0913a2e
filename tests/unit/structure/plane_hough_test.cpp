// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_hough.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "flat_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/structure/plane_ransac.hpp"
#include "support/contexts.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// The six faces of a box, turned anyhow, and some clutter.
PointCloud box(const Transform& pose, double noise, int num_clutter) {
    Random random(12);
    PointCloud cloud;
    const Vector3d x = 4.0 * Vector3d::UnitX();
    const Vector3d y = 3.0 * Vector3d::UnitY();
    const Vector3d z = 2.5 * Vector3d::UnitZ();
    for (const Vector3d& corner : {Vector3d(0, 0, 0), Vector3d(4, 3, 2.5)}) {
        const double sign = corner.isZero() ? 1.0 : -1.0;
        test::add_rectangle(cloud, corner, sign * x, sign * y, 0.05, noise, random);
        test::add_rectangle(cloud, corner, sign * y, sign * z, 0.05, noise, random);
        test::add_rectangle(cloud, corner, sign * z, sign * x, 0.05, noise, random);
    }
    for (int i = 0; i < num_clutter; ++i) {
        cloud.positions.emplace_back(
            Vector3d(random.uniform(0, 4), random.uniform(0, 3), random.uniform(0, 2.5))
                .cast<float>());
    }
    cloud.normals.clear();
    for (Eigen::Vector3f& position : cloud.positions)
        position = (pose * position.cast<double>()).cast<float>();
    return cloud;
}

Transform some_pose(double angle) {
    Transform pose = Transform::Identity();
    pose.rotate(Eigen::AngleAxisd(angle, Vector3d(0.3, -0.5, 0.8).normalized()));
    pose.translation() = Vector3d(20.0, -7.0, 3.0);
    return pose;
}

TEST(DetectPlanesHough, FindsTheSixFacesOfABoxInAnyPose) {
    for (const double angle : {0.0, 0.7, 2.1}) {
        for (const double noise : {0.0, 0.005}) {
            SCOPED_TRACE(angle);
            const Transform pose = some_pose(angle);
            const PlaneDetectionResult result =
                detect_planes_hough(box(pose, noise, 2000), {.detection = {.min_inliers = 1000}});
            ASSERT_EQ(result.planes.size(), 6U);
            for (const PlanarPatch& patch : result.planes) {
                const Vector3d normal = pose.linear().transpose() * patch.plane.normal;
                EXPECT_GT(normal.cwiseAbs().maxCoeff(), std::cos(radians(0.2)));
            }
        }
    }
}

TEST(DetectPlanesHough, FindsNoFewerInliersThanTheBestOfTenDraws) {
    const PointCloud cloud = box(some_pose(0.4), 0.008, 20'000);
    const auto hough =
        detect_planes_hough(cloud, {.detection = {.min_inliers = 1000, .max_planes = 1}});
    ASSERT_EQ(hough.planes.size(), 1U);
    std::size_t most = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const auto drawn = detect_planes_ransac(
            cloud, seed, {.detection = {.min_inliers = 1000, .max_planes = 1}, .consensus = {}});
        most = std::max(most, drawn.planes.at(0).points.size());
    }
    EXPECT_GE(static_cast<double>(hough.planes[0].points.size()), 0.99 * static_cast<double>(most));
}

TEST(DetectPlanesHough, DoesNotDependOnThreadsOrOrder) {
    const PointCloud cloud = box(some_pose(1.0), 0.005, 3000);
    const auto one =
        detect_planes_hough(cloud, {.detection = {.min_inliers = 1000}}, test::with_threads(1));
    const auto many =
        detect_planes_hough(cloud, {.detection = {.min_inliers = 1000}}, test::with_threads(3));
    PointCloud reversed = cloud;
    std::reverse(reversed.positions.begin(), reversed.positions.end());
    const auto turned = detect_planes_hough(reversed, {.detection = {.min_inliers = 1000}});
    ASSERT_EQ(one.planes.size(), many.planes.size());
    ASSERT_EQ(one.planes.size(), turned.planes.size());
    for (std::size_t i = 0; i < one.planes.size(); ++i) {
        EXPECT_EQ(one.planes[i].plane.normal, many.planes[i].plane.normal);
        EXPECT_EQ(one.planes[i].points, many.planes[i].points);
        EXPECT_GT(std::abs(one.planes[i].plane.normal.dot(turned.planes[i].plane.normal)),
                  1.0 - 1e-9);
        EXPECT_EQ(one.planes[i].points.size(), turned.planes[i].points.size());
    }
}

TEST(DetectPlanesHough, SaysWhyItStops) {
    EXPECT_EQ(detect_planes_hough({}).stop, PlaneDetectionStop::few_points_left);
    PointCloud line;
    for (int i = 0; i < 100; ++i)
        line.positions.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
    line.positions[3].x() = std::numeric_limits<float>::quiet_NaN();
    const auto of_line =
        detect_planes_hough(line, {.detection = {.distance_tolerance = 1e-4, .min_inliers = 120}});
    EXPECT_EQ(of_line.stop, PlaneDetectionStop::few_points_left);
    EXPECT_EQ(of_line.remaining_points.size(), 99U);
    const PointCloud cloud = box(some_pose(0.0), 0.005, 100);
    EXPECT_EQ(
        detect_planes_hough(cloud, {.detection = {.min_inliers = 1000, .max_planes = 2}}).stop,
        PlaneDetectionStop::max_planes);
    EXPECT_EQ(detect_planes_hough(cloud, {.detection = {.min_inliers = 12'000}}).stop,
              PlaneDetectionStop::few_inliers_left);
    EXPECT_THROW(detect_planes_hough(cloud, {.detection = {.distance_tolerance = 0.0}}),
                 InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
