// SPDX-License-Identifier: MIT
#include "roomscribe/structure/outlined_patches.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace roomscribe {
namespace {

/// A wall of 4 x 2.5 m at y = 1 with a window's hole of 1.2 x 1 m, as points every 2 cm, and a
/// patch too small to be seen.
SurfaceSample wall_with_hole(std::vector<PlanarPatch>& patches) {
    SurfaceSample sample;
    sample.spacing = 0.02;
    std::vector<std::uint32_t> wall;
    for (int i = 0; i <= 200; ++i) {
        for (int k = 0; k <= 125; ++k) {
            if (i > 80 && i < 140 && k > 40 && k < 90) continue;
            wall.push_back(static_cast<std::uint32_t>(sample.cloud.size()));
            sample.cloud.positions.emplace_back(0.02F * static_cast<float>(i), 1.0F,
                                                0.02F * static_cast<float>(k));
        }
    }
    patches.push_back(make_planar_patch(sample.cloud, {-Eigen::Vector3d::UnitY(), 1.0}, wall));
    patches.back().area = 8.8;
    patches.push_back(make_planar_patch(sample.cloud, {-Eigen::Vector3d::UnitY(), 1.0},
                                        {wall.begin(), wall.begin() + 100}));
    patches.back().area = 0.01;
    return sample;
}

TEST(OutlinePatches, ShowsRimsLinesAndRectanglesOfAWall) {
    std::vector<PlanarPatch> patches;
    const SurfaceSample sample = wall_with_hole(patches);
    const std::vector<OutlinedPatch> outlined = outline_patches(sample, patches);
    ASSERT_EQ(outlined.size(), 1U);
    const OutlinedPatch& wall = outlined.front();
    EXPECT_EQ(wall.points.size(), sample.cloud.size());
    for (const Eigen::Vector3f& point : wall.boundary) {
        EXPECT_NEAR(point.y(), 1.0F, 1e-4F);
        const bool on_hole =
            point.x() > 1.5F && point.x() < 2.9F && point.z() > 0.7F && point.z() < 1.9F;
        const bool on_rim =
            point.x() < 0.05F || point.x() > 3.95F || point.z() < 0.05F || point.z() > 2.45F;
        EXPECT_TRUE(on_hole || on_rim) << point.transpose();
    }
    EXPECT_GE(wall.lines.size(), 8U);
    const auto is_hole = [](const std::array<Eigen::Vector3f, 4>& corners) {
        Eigen::AlignedBox3f box;
        for (const Eigen::Vector3f& corner : corners)
            box.extend(corner);
        return std::abs(box.sizes().x() - 1.2F) < 0.05F && std::abs(box.sizes().z() - 1.0F) < 0.05F;
    };
    EXPECT_EQ(std::count_if(wall.rectangles.begin(), wall.rectangles.end(), is_hole), 1);
}

TEST(OutlinePatches, IsEmptyWithoutPatches) {
    EXPECT_TRUE(outline_patches({}, {}).empty());
}

}  // namespace
}  // namespace roomscribe
