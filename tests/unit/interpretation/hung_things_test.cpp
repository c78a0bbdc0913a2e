// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/hung_things.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr double step = 0.03;  // m, between voxels

/// A wall in the plane x = 0, 4 m long and 2.5 m high, and a flat thing before it.
struct WallWithThing {
    SurfaceSample sample;
    std::vector<PlanarPatch> patches{2};
    WallFace face;
    WallRectangle thing;

    WallWithThing(const WallRectangle& where, double depth) : thing(where) {
        sample.spacing = step;
        sample.voxel_size = step;
        sample.noise = 0.004;
        sample.normals_face_scanner = true;
        face.plane = {Vector3d::UnitX(), 0.0};
        face.along = Vector3d::UnitY();
        face.end = 4.0;
        face.top = 2.5;
        for (double y = 0.5 * step; y < face.end; y += step) {
            for (double z = 0.5 * step; z < face.top; z += step) {
                const bool is_thing =
                    y > where.start && y < where.end && z > where.bottom && z < where.top;
                PlanarPatch& patch = patches[is_thing ? 1 : 0];
                patch.points.push_back(static_cast<std::uint32_t>(sample.cloud.size()));
                const Vector3d place(is_thing ? depth : 0.0, y, z);
                patch.centroid += place;
                sample.cloud.positions.push_back(place.cast<float>());
            }
        }
        for (PlanarPatch& patch : patches) {
            const auto count = static_cast<double>(patch.points.size());
            patch.centroid /= count;
            patch.area = step * step * count;
            patch.plane = {Vector3d::UnitX(), patch.centroid.x()};
        }
    }

    /// Number of voxels of the wall and of the thing that were marked.
    std::pair<std::size_t, std::size_t> mark() const {
        std::vector<bool> is_hung(sample.cloud.size(), false);
        mark_hung_things(sample, patches, {&face, 1}, Vector3d::UnitZ(), is_hung);
        const auto count = [&](const PlanarPatch& patch) {
            return static_cast<std::size_t>(
                std::count_if(patch.points.begin(), patch.points.end(),
                              [&](std::uint32_t voxel) { return is_hung[voxel]; }));
        };
        return {count(patches[0]), count(patches[1])};
    }
};

TEST(HungThings, ArePicturesAndBoards) {
    for (const WallRectangle& where :
         {WallRectangle{1.0, 1.6, 1.2, 1.8}, WallRectangle{1.0, 3.2, 0.9, 2.1}}) {
        const WallWithThing wall(where, 0.02);
        const auto [of_wall, of_thing] = wall.mark();
        EXPECT_EQ(of_wall, 0U);
        EXPECT_GE(of_thing, 9 * wall.patches[1].points.size() / 10);
    }
}

TEST(HungThings, HaveTheWallOnAllSides) {
    const auto none = std::pair<std::size_t, std::size_t>(0, 0);
    EXPECT_EQ(WallWithThing({1.0, 1.9, 0.0, 2.0}, 0.02).mark(), none) << "a leaf on the floor";
    EXPECT_EQ(WallWithThing({2.5, 4.0, 0.5, 2.0}, 0.02).mark(), none) << "where the wall bends";
}

TEST(HungThings, StandAStepBeforeTheWall) {
    const auto none = std::pair<std::size_t, std::size_t>(0, 0);
    EXPECT_EQ(WallWithThing({1.0, 1.6, 1.2, 1.8}, -0.02).mark(), none) << "a niche";
    EXPECT_EQ(WallWithThing({1.0, 1.6, 1.2, 1.8}, 0.004).mark(), none) << "the wall's own relief";
    EXPECT_EQ(WallWithThing({1.0, 1.6, 1.2, 1.8}, 0.15).mark(), none) << "a wall unit";
}

}  // namespace
}  // namespace roomscribe
