// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_growing.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "flat_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"

namespace roomscribe {
namespace {

using test::add_rectangle;

Context with_threads(int count) {
    Context context;
    context.num_threads = count;
    return context;
}

PointCloud corner_of_room(double noise) {
    Random random(7);
    PointCloud cloud;
    const Eigen::Vector3d x = 3.0 * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d y = 2.0 * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d z = 2.5 * Eigen::Vector3d::UnitZ();
    add_rectangle(cloud, Eigen::Vector3d::Zero(), x, y, 0.05, noise, random);
    add_rectangle(cloud, Eigen::Vector3d::Zero(), y, z, 0.05, noise, random);
    add_rectangle(cloud, Eigen::Vector3d::Zero(), z, x, 0.05, noise, random);
    return cloud;
}

TEST(GrowPlanarPatches, FindsTheThreePlanesOfACorner) {
    for (const double noise : {0.0, 0.005}) {
        const PointCloud cloud = corner_of_room(noise);
        const auto patches = grow_planar_patches(cloud);
        ASSERT_EQ(patches.size(), 3U) << "noise " << noise;
        // Largest first: 3 x 2.5, 3 x 2, 2 x 2.5.
        EXPECT_GT(patches[0].plane.normal.y(), 0.9999);
        EXPECT_GT(patches[1].plane.normal.z(), 0.9999);
        EXPECT_GT(patches[2].plane.normal.x(), 0.9999);
        for (const PlanarPatch& patch : patches) {
            EXPECT_NEAR(patch.plane.offset, 0.0, 0.003);
            EXPECT_LE(patch.rms, noise + 0.002);
        }
        EXPECT_NEAR(patches[0].area, 7.5, 0.4);
        std::size_t covered = 0;
        for (const PlanarPatch& patch : patches)
            covered += patch.points.size();
        EXPECT_GE(covered, cloud.size() * 99 / 100);
    }
}

TEST(GrowPlanarPatches, KeepsCoplanarPatchesThatDoNotTouchApart) {
    Random random(1);
    PointCloud cloud;
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
    add_rectangle(cloud, Eigen::Vector3d::Zero(), x, y, 0.04, 0.002, random);
    add_rectangle(cloud, Eigen::Vector3d(1.5, 0, 0), x, y, 0.04, 0.002, random);
    EXPECT_EQ(grow_planar_patches(cloud).size(), 2U);
}

TEST(GrowPlanarPatches, HoldsAPlaneOfVeryUnevenDensityTogether) {
    Random random(3);
    PointCloud cloud;
    const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
    // 1000 times the density: steps of 5 mm and of 158 mm.
    add_rectangle(cloud, Eigen::Vector3d::Zero(), 0.5 * Eigen::Vector3d::UnitX(), y, 0.005, 0.001,
                  random);
    add_rectangle(cloud, Eigen::Vector3d(0.5, 0, 0), 4.0 * Eigen::Vector3d::UnitX(), 3.0 * y, 0.158,
                  0.001, random);
    const auto patches = grow_planar_patches(cloud);
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_GE(patches[0].points.size(), cloud.size() * 99 / 100);
}

TEST(GrowPlanarPatches, DoesNotDependOnOrderThreadsOrPose) {
    const PointCloud cloud = corner_of_room(0.004);
    const auto patches = grow_planar_patches(cloud, {}, with_threads(1));
    const auto threaded = grow_planar_patches(cloud, {}, with_threads(2));
    ASSERT_EQ(patches.size(), threaded.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
        EXPECT_EQ(patches[i].points, threaded[i].points);
        EXPECT_EQ(patches[i].plane.normal, threaded[i].plane.normal);
    }

    std::vector<std::uint32_t> order(cloud.size());
    std::iota(order.begin(), order.end(), 0U);
    Random random(5);
    for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    }
    PointCloud turned = select_points(cloud, order);
    Transform pose = Transform::Identity();
    pose.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).matrix();
    pose.translation() = Eigen::Vector3d(3, -2, 1);
    transform_in_place(turned, pose);
    const auto again = grow_planar_patches(turned);
    ASSERT_EQ(again.size(), patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
        EXPECT_GT(again[i].plane.normal.dot(pose.linear() * patches[i].plane.normal), 0.99999);
        EXPECT_NEAR(static_cast<double>(again[i].points.size()),
                    static_cast<double>(patches[i].points.size()),
                    0.01 * static_cast<double>(cloud.size()));
    }
}

TEST(GrowPlanarPatches, FindsNothingWhereNothingIsPlanar) {
    EXPECT_TRUE(grow_planar_patches({}).empty());
    PointCloud few;
    Random random(2);
    for (int i = 0; i < 10; ++i) {
        few.positions.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
        few.normals.emplace_back(0.0F, 0.0F, 1.0F);
    }
    EXPECT_TRUE(grow_planar_patches(few).empty());
    PointCloud equal;
    equal.positions.assign(500, Eigen::Vector3f(1, 2, 3));
    equal.normals.assign(500, Eigen::Vector3f(0, 0, 1));
    EXPECT_TRUE(grow_planar_patches(equal).empty());
}

TEST(GrowPlanarPatches, RejectsWhatItCannotUse) {
    PointCloud cloud = corner_of_room(0.0);
    cloud.normals.clear();
    EXPECT_THROW(grow_planar_patches(cloud), InvalidArgument);
    cloud = corner_of_room(0.0);
    cloud.positions[3].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(grow_planar_patches(cloud), InvalidArgument);
    EXPECT_THROW(grow_planar_patches({}, {.distance_tolerance = -1.0}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
