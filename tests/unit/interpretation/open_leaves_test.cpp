// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/open_leaves.hpp"

#include <functional>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr double spacing = 0.03;  // m

/// A wall in the plane y = 0 before a hole from x = 0 to 0.9, 2 m high.
class Hole {
  public:
    Hole() {
        sample.spacing = sample.voxel_size = spacing;
        face.plane.normal = Vector3d::UnitY();
        face.along = Vector3d::UnitZ().cross(face.plane.normal);
    }

    /// A patch parallel to the wall, `depth` behind it, where `is_there(across, above)`.
    void add_parallel(double depth, const std::function<bool(double, double)>& is_there) {
        PlanarPatch patch;
        patch.plane.normal = Vector3d::UnitY();
        patch.plane.offset = -depth;
        for (double across = 0.015; across < 0.9; across += spacing) {
            for (double above = 0.015; above < 2.0; above += spacing) {
                if (is_there(across, above)) add(patch, across, -depth, above);
            }
        }
        push(patch);
    }
    /// A reveal at one side, from the face to `depth`.
    void add_reveal(double across, double depth) {
        PlanarPatch patch;
        patch.plane.normal = Vector3d::UnitX();
        patch.plane.offset = face.along.x() * across;
        for (double behind = 0.005; behind < depth; behind += spacing) {
            for (double above = 0.015; above < 2.0; above += spacing)
                add(patch, across, -behind, above);
        }
        push(patch);
    }

    OpenLeafFinder finder() const { return {sample, patches, Vector3d::UnitZ()}; }

    SurfaceSample sample;
    std::vector<PlanarPatch> patches;
    WallFace face;
    WallRectangle rectangle{0.0, 0.9, 0.0, 2.0};

  private:
    void add(PlanarPatch& patch, double across, double y, double above) {
        patch.points.push_back(static_cast<std::uint32_t>(sample.cloud.size()));
        const Vector3d place = across * face.along + Vector3d(0.0, y, above);
        sample.cloud.positions.push_back(place.cast<float>());
    }
    void push(PlanarPatch& patch) {
        patch.centroid = Vector3d::Zero();
        for (const std::uint32_t point : patch.points)
            patch.centroid += sample.cloud.positions[point].cast<double>();
        patch.centroid /= static_cast<double>(patch.points.size());
        patches.push_back(patch);
    }
};

bool everywhere(double /*across*/, double /*above*/) {
    return true;
}

TEST(OpenLeaves, AClosedLeafAtTheFarSideOfAThickWallFillsItsHole) {
    Hole hole;
    hole.add_reveal(0.0, 0.3);
    hole.add_reveal(0.9, 0.3);
    EXPECT_FALSE(hole.finder().closed_leaf_depth(hole.face, hole.rectangle));
    hole.add_parallel(0.26, everywhere);
    const auto depth = hole.finder().closed_leaf_depth(hole.face, hole.rectangle);
    ASSERT_TRUE(depth);
    EXPECT_NEAR(*depth, 0.26, 0.0125);
}

TEST(OpenLeaves, AFrameAndTheNextRoomsWallFillNone) {
    Hole hole;
    hole.add_parallel(0.1, [](double across, double above) {
        return across < 0.06 || across > 0.84 || above > 1.94;
    });
    hole.add_parallel(0.9, everywhere);
    EXPECT_FALSE(hole.finder().closed_leaf_depth(hole.face, hole.rectangle));
}

TEST(OpenLeaves, TheLiningTellsTheThicknessOfAWall) {
    Hole hole;
    EXPECT_FALSE(hole.finder().lining_depth(hole.face, hole.rectangle, 0.6));
    hole.add_reveal(0.0, 0.28);
    ASSERT_TRUE(hole.finder().lining_depth(hole.face, hole.rectangle, 0.6));
    // A leaf stands open in the plane of the other side.
    hole.add_reveal(0.9, 1.1);
    const auto depth = hole.finder().lining_depth(hole.face, hole.rectangle, 0.6);
    ASSERT_TRUE(depth);
    EXPECT_NEAR(*depth, 0.28, spacing);
}

}  // namespace
}  // namespace roomscribe
