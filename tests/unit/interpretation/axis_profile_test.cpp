// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/upright/axis_profile.hpp"

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Level squares in one sample, a patch each.
struct LevelSquares {
    SurfaceSample sample;
    std::vector<PlanarPatch> patches;

    void add(double x, double y, double z, double side) {
        constexpr double step = 0.1;
        PlanarPatch& patch = patches.emplace_back();
        for (double i = 0.5 * step; i < side; i += step) {
            for (double j = 0.5 * step; j < side; j += step) {
                patch.points.push_back(static_cast<std::uint32_t>(sample.cloud.positions.size()));
                sample.cloud.positions.push_back(Vector3d(x + i, y + j, z).cast<float>());
                sample.cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
            }
        }
        patch.plane = {Vector3d::UnitZ(), z};
        patch.centroid = Vector3d(x + 0.5 * side, y + 0.5 * side, z);
        patch.area = side * side;
    }
};

TEST(AxisProfile, LeavesOutTheGroundBelowAnUpperStorey) {
    LevelSquares scene;
    scene.add(0.0, 0.0, 0.0, 5.0);
    scene.add(0.0, 0.0, 2.6, 5.0);
    scene.add(20.0, 0.0, -10.0, 3.0);
    AxisProfile profile = profile_along(Vector3d::UnitZ(), scene.sample, scene.patches, {});
    ASSERT_TRUE(profile.low && profile.high);
    EXPECT_NEAR(*profile.low, 0.0, 1e-6);
    EXPECT_NEAR(*profile.high, 2.6, 1e-6);
    EXPECT_NEAR(profile.bottom, 0.0, 1e-6);
    reverse(profile);
    EXPECT_NEAR(*profile.low, -2.6, 1e-6);
    EXPECT_NEAR(*profile.high, 0.0, 1e-6);
}

TEST(AxisProfile, KeepsAllLevelsWhereNoCeilingWasSeen) {
    LevelSquares scene;
    scene.add(0.0, 0.0, 0.0, 5.0);
    scene.add(20.0, 0.0, -1.0, 3.0);
    const AxisProfile profile = profile_along(Vector3d::UnitZ(), scene.sample, scene.patches, {});
    ASSERT_TRUE(profile.low);
    EXPECT_NEAR(*profile.low, -1.0, 1e-6);
}

TEST(AxisProfile, KeepsTheStoreyBelow) {
    LevelSquares scene;
    scene.add(0.0, 0.0, 0.0, 5.0);
    scene.add(0.0, 0.0, 2.6, 5.0);
    scene.add(0.0, 0.0, -2.9, 4.0);
    const AxisProfile profile = profile_along(Vector3d::UnitZ(), scene.sample, scene.patches, {});
    ASSERT_TRUE(profile.low);
    EXPECT_NEAR(*profile.low, -2.9, 1e-6);
}

}  // namespace
}  // namespace roomscribe
