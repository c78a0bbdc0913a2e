// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/level_surfaces.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

struct Extent {
    double from = 0.0;  ///< m along x
    double to = 0.0;
};

/// Level surfaces that are 4 m wide, each a patch that looks up or down as a scanner saw it.
struct LevelScene {
    SurfaceSample sample;
    std::vector<PlanarPatch> patches;

    void add(double height, Extent x, double looks_up) {
        constexpr double step = 0.1;
        constexpr double width = 4.0;
        PlanarPatch patch;
        for (double at_x = x.from; at_x < x.to; at_x += step) {
            for (double at_y = 0.0; at_y < width; at_y += step) {
                patch.points.push_back(static_cast<std::uint32_t>(sample.cloud.positions.size()));
                sample.cloud.positions.push_back(Vector3d(at_x, at_y, height).cast<float>());
            }
        }
        patch.area = width * (x.to - x.from);
        patch.centroid = Vector3d((x.from + x.to) / 2.0, width / 2.0, height);
        patch.plane = {looks_up * Vector3d::UnitZ(), looks_up * height};
        patches.push_back(std::move(patch));
    }
    /// A slope 4 m wide that looks down, from one height up to another.
    void add_slope(double degrees, double from, double to) {
        constexpr double step = 0.1;
        const double angle = degrees * M_PI / 180.0;
        const double length = (to - from) / std::sin(angle);
        PlanarPatch patch;
        for (double along = 0.0; along < length; along += step) {
            for (double at_y = 0.0; at_y < 4.0; at_y += step) {
                patch.points.push_back(static_cast<std::uint32_t>(sample.cloud.positions.size()));
                sample.cloud.positions.push_back(
                    Vector3d(along * std::cos(angle), at_y, from + along * std::sin(angle))
                        .cast<float>());
            }
        }
        patch.area = 4.0 * length;
        patch.centroid = Vector3d(0.5 * length * std::cos(angle), 2.0, 0.5 * (from + to));
        patch.plane.normal = Vector3d(std::sin(angle), 0.0, -std::cos(angle));
        patch.plane.offset = patch.plane.normal.dot(patch.centroid);
        patches.push_back(std::move(patch));
    }
    std::vector<Storey> storeys() const {
        return find_storeys(sample, patches, Vector3d::UnitZ(), true, {});
    }
};

/// A room of 5 x 4 m, and ground beyond its window.
LevelScene room_with_ground(double ground_height, Extent ground) {
    LevelScene scene;
    scene.add(0.0, {0.0, 5.0}, 1.0);
    scene.add(2.6, {0.0, 5.0}, -1.0);
    scene.add(ground_height, ground, 1.0);
    return scene;
}

TEST(LevelSurfaces, GroundSeenThroughAWindowIsNoFloor) {
    // Less than a step and more than a storey below the floor, and larger than the room.
    for (const double ground : {-0.15, -0.45, -1.2, -3.0}) {
        const std::vector<Storey> storeys = room_with_ground(ground, {6.0, 16.0}).storeys();
        ASSERT_EQ(storeys.size(), 1U) << ground;
        ASSERT_TRUE(storeys[0].floor) << ground;
        EXPECT_NEAR(storeys[0].floor->height, 0.0, 1e-9) << ground;
        ASSERT_TRUE(storeys[0].ceiling_height()) << ground;
        EXPECT_NEAR(*storeys[0].ceiling_height(), 2.6, 1e-9) << ground;
    }
}

TEST(LevelSurfaces, ALowerPartOfTheRoomIsAFloor) {
    LevelScene scene = room_with_ground(-0.3, {5.0, 10.0});
    scene.add(2.7, {5.0, 10.0}, -1.0);
    const std::vector<Storey> storeys = scene.storeys();
    ASSERT_EQ(storeys.size(), 1U);
    ASSERT_TRUE(storeys[0].floor);
    EXPECT_EQ(storeys[0].other_floors.size(), 1U);
}

TEST(LevelSurfaces, WithoutACeilingTheLowestIsTheFloor) {
    LevelScene scene;
    scene.add(0.0, {0.0, 5.0}, 1.0);
    scene.add(-0.45, {6.0, 16.0}, 1.0);
    const std::vector<Storey> storeys = scene.storeys();
    ASSERT_EQ(storeys.size(), 1U);
    ASSERT_TRUE(storeys[0].floor);
    EXPECT_NEAR(storeys[0].floor->height, -0.45, 1e-9);
}

TEST(LevelSurfaces, ARoofsSlopeIsCeilingIfItRisesToARoomsHeight) {
    for (const auto& [degrees, from, to, count] :
         {std::tuple(40.0, 0.9, 2.4, 1U), std::tuple(55.0, 0.9, 2.4, 1U),
          // A wall that leans, and the underside of something low.
          std::tuple(55.0, 0.0, 2.4, 0U), std::tuple(40.0, 0.4, 1.5, 0U)}) {
        LevelScene scene;
        scene.add(0.0, {0.0, 5.0}, 1.0);
        scene.add(2.4, {1.5, 3.5}, -1.0);
        scene.add_slope(degrees, from, to);
        const std::vector<Storey> storeys = scene.storeys();
        ASSERT_EQ(storeys.size(), 1U);
        EXPECT_EQ(storeys[0].sloping_ceilings.size(), count) << degrees << ' ' << from;
        EXPECT_NEAR(*storeys[0].ceiling_height(), 2.4, 1e-9);
    }
}

TEST(LevelSurfaces, AnUpperFloorWhoseUndersideIsSeenFromBelowIsAFloor) {
    for (const bool is_marked : {true, false}) {
        LevelScene scene;
        scene.add(0.0, {0.0, 5.0}, 1.0);
        scene.add(2.6, {0.0, 3.0}, -1.0);
        // From below, where the ceiling was not scanned, most of the views see it.
        scene.add(3.4, {0.0, 5.0}, -1.0);
        scene.patches.back().may_face_both_ways = is_marked;
        scene.add(6.0, {0.0, 5.0}, -1.0);
        EXPECT_EQ(scene.storeys().size(), is_marked ? 2U : 1U);
    }
}

}  // namespace
}  // namespace roomscribe
