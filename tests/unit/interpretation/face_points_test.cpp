// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/fixtures/face_points.hpp"

#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// The far side of a leaf 4 cm thick, of one voxel per point, whose face looks along x and lies at
/// the near side; and a bar before the face.
struct LeafFromBehind {
    ScanMap map;
    SurfaceSample sample;
    MountingFace face;

    LeafFromBehind() {
        face.plane = {Vector3d::UnitX(), 0.0};
        face.along = Vector3d::UnitY();
        face.extent = {0.0, 1.0, 0.0, 2.0};
        add(Vector3f(0.04F, 0.5F, 1.0F), -Vector3f::UnitX());  // seen from behind
        add(Vector3f(0.04F, 0.5F, 1.2F), Vector3f::UnitX());   // a bar's front
        add(Vector3f(0.04F, 0.5F, 1.3F), Vector3f::UnitY());   // its side
        sample.voxel_size = 0.04;
        sample.normals_face_scanner = true;
        map.sections.push_back({"map", 0, 3, std::nullopt});
    }
    void add(const Vector3f& position, const Vector3f& normal) {
        sample.voxel_of_point.push_back(static_cast<std::uint32_t>(sample.cloud.size()));
        sample.cloud.positions.push_back(position);
        sample.cloud.normals.push_back(normal);
        map.cloud.positions.push_back(position);
    }
};

TEST(GatherFacePoints, LeavesOutWhatInferredViewsSeeFromBehind) {
    const LeafFromBehind leaf;
    const auto points = gather_face_points(leaf.map, leaf.sample, std::vector{leaf.face}, {});
    ASSERT_EQ(points.size(), 1U);
    ASSERT_EQ(points[0].size(), 2U);
    EXPECT_EQ(points[0][0].point, 1U);
    EXPECT_EQ(points[0][1].point, 2U);
}

TEST(GatherFacePoints, AskTheViewsOfAPointBeforeItsVoxel) {
    // Voxels are as large as leaves are thick: one holds points of both sides.
    LeafFromBehind leaf;
    leaf.map.inferred_views = {{Vector3d(-2.0, 0.5, 1.0), {1, 2}}, {Vector3d(2.0, 0.5, 1.0), {0}}};
    const auto points = gather_face_points(leaf.map, leaf.sample, std::vector{leaf.face}, {});
    ASSERT_EQ(points[0].size(), 1U);
    EXPECT_EQ(points[0][0].point, 0U);
}

TEST(GatherFacePoints, LeaveTheSidesToTheScannersThatAreKnown) {
    LeafFromBehind leaf;
    leaf.sample.sensor_positions = {Vector3d(2.0, 0.5, 1.0)};
    EXPECT_EQ(gather_face_points(leaf.map, leaf.sample, std::vector{leaf.face}, {})[0].size(), 3U);
}

}  // namespace
}  // namespace roomscribe
