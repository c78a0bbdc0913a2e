// SPDX-License-Identifier: MIT
#include "roomscribe/structure/surface_sample.hpp"

#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A leaf whose sides lie 0.12 m apart in x, the second behind the first, of points 2 cm apart.
struct Leaf {
    ScanMap map;
    SurfaceSample sample;
    std::vector<PlanarPatch> patches;

    Leaf() {
        for (const float x : {0.0F, -0.12F}) {
            for (float y = 0.0F; y < 1.0F; y += 0.02F) {
                for (float z = 0.0F; z < 2.0F; z += 0.02F)
                    map.cloud.positions.emplace_back(x, y, z);
            }
        }
        map.sections.push_back(
            {"map", 0, static_cast<std::uint32_t>(map.cloud.size()), std::nullopt});
        sample = sample_surface(map, {.point_spacing = 0.02, .noise = 0.001});
        for (const float x : {0.0F, -0.12F}) {
            std::vector<std::uint32_t> voxels;
            for (std::uint32_t i = 0; i < sample.cloud.size(); ++i) {
                if (std::abs(sample.cloud.positions[i].x() - x) < 0.04F) voxels.push_back(i);
            }
            patches.push_back(make_planar_patch(
                sample.cloud, {Vector3d::UnitX(), static_cast<double>(x)}, voxels));
        }
    }
    std::vector<std::uint32_t> side(std::uint32_t number) const {
        const auto count = static_cast<std::uint32_t>(map.cloud.size() / 2);
        std::vector<std::uint32_t> points;
        // The upper half of each side was seen by nobody.
        for (std::uint32_t i = 0; i < count; ++i) {
            if (map.cloud.positions[i].z() < 1.0F) points.push_back(number * count + i);
        }
        return points;
    }
};

TEST(FaceInferredViews, TurnsNormalsAndPatchesToThem) {
    Leaf leaf;
    ASSERT_FALSE(leaf.sample.normals_face_scanner);
    leaf.map.inferred_views = {{Vector3d(2.0, 0.5, 1.0), leaf.side(0)},
                               {Vector3d(-2.0, 0.5, 1.0), leaf.side(1)}};
    EXPECT_TRUE(face_inferred_views(leaf.map, leaf.sample, leaf.patches));
    EXPECT_TRUE(leaf.sample.normals_face_scanner);
    EXPECT_TRUE(leaf.sample.sensor_positions.empty());
    for (std::size_t i = 0; i < leaf.sample.cloud.size(); ++i) {
        const bool is_first = leaf.sample.cloud.positions[i].x() > -0.06F;
        EXPECT_EQ(leaf.sample.cloud.normals[i].x() > 0.0F, is_first)
            << leaf.sample.cloud.positions[i].transpose();
    }
    EXPECT_GT(leaf.patches[0].plane.normal.x(), 0.9);
    EXPECT_LT(leaf.patches[1].plane.normal.x(), -0.9);
}

TEST(FaceInferredViews, MarksWhatIsSeenFromBothSides) {
    Leaf leaf;
    leaf.map.inferred_views = {{Vector3d(2.0, 0.5, 1.0), leaf.side(0)},
                               {Vector3d(-2.0, 0.5, 1.0), leaf.side(0)},
                               {Vector3d(-2.0, 0.5, 1.5), leaf.side(1)}};
    ASSERT_TRUE(face_inferred_views(leaf.map, leaf.sample, leaf.patches));
    EXPECT_TRUE(leaf.patches[0].may_face_both_ways);
    EXPECT_FALSE(leaf.patches[1].may_face_both_ways);
}

TEST(FaceInferredViews, DoesNothingWithoutThem) {
    Leaf leaf;
    EXPECT_FALSE(face_inferred_views(leaf.map, leaf.sample, leaf.patches));
    EXPECT_FALSE(leaf.sample.normals_face_scanner);
}

}  // namespace
}  // namespace roomscribe
