// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/wall_faces.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double step = 0.04;  // m, between voxels
constexpr double ceiling = 2.5;

/// A room of 3 x 4 m before the plane x = 0, with upright surfaces of one patch each. Rays are not
/// known.
struct RoomWithSurfaces {
    FloorPlan plan{Vector2d(-1.5, 0.0), Vector2d(3.0, 4.0), 0.05};
    SurfaceSample sample;
    std::vector<PlanarPatch> patches;
    std::vector<UprightSurface> surfaces;

    RoomWithSurfaces() {
        sample.spacing = step;
        sample.voxel_size = step;
        sample.tolerance = 0.01;
        sample.normals_face_scanner = true;
        plan.rooms.push_back({0.0, ceiling, ceiling});
        for (std::size_t cell = 0; cell < plan.num_cells(); ++cell) {
            if (plan.middle_of(cell).x() < 0.0) continue;
            plan.room_of_cell[cell] = 0;
            plan.has_level[cell] = true;
            plan.ceiling_of_cell[cell] = static_cast<float>(ceiling);
        }
    }

    /// From `foot`, in a direction `degrees` from y, turning towards x < 0; surface is where
    /// `is_there(along, z)`.
    void add(const Vector3d& foot, double degrees, double length, double height,
             const std::function<bool(double, double)>& is_there) {
        const double angle = degrees * M_PI / 180.0;
        const Vector3d along(-std::sin(angle), std::cos(angle), 0.0);
        UprightSurface surface;
        surface.plane.normal = Vector3d(std::cos(angle), std::sin(angle), 0.0);
        surface.plane.offset = surface.plane.normal.dot(foot);
        surface.along = along;
        surface.start = foot.dot(along);
        surface.end = surface.start + length;
        surface.top = height;
        surface.patches = {static_cast<std::uint32_t>(patches.size())};
        PlanarPatch& patch = patches.emplace_back();
        patch.plane = surface.plane;
        for (double a = 0.5 * step; a < length; a += step) {
            for (double z = 0.5 * step; z < height; z += step) {
                if (!is_there(a, z)) continue;
                patch.points.push_back(static_cast<std::uint32_t>(sample.cloud.size()));
                const Vector3d place = foot + a * along + Vector3d(0.0, 0.0, z);
                sample.cloud.positions.push_back(place.cast<float>());
                sample.noise_of_voxel.push_back(0.005F);
            }
        }
        surfaces.push_back(surface);
    }

    std::vector<WallFace> find() const {
        return find_wall_faces({}, sample, patches, surfaces, plan, Eigen::Matrix3d::Identity(),
                               {});
    }
};

bool everywhere(double /*along*/, double /*z*/) {
    return true;
}
/// But for a doorway from 1.5 to 2.4 m, 2 m high.
bool but_for_a_doorway(double along, double z) {
    return along < 1.5 || along > 2.4 || z > 2.0;
}

TEST(WallFaces, ALeafThatStandsAjarInADoorwayIsNone) {
    RoomWithSurfaces room;
    room.add(Vector3d::Zero(), 0.0, 4.0, ceiling, but_for_a_doorway);
    room.add(Vector3d(0.0, 1.52, 0.0), 25.0, 0.85, 1.98, everywhere);
    const std::vector<WallFace> faces = room.find();
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_NEAR(faces[0].width(), 4.0, 2.0 * step);
}

TEST(WallFaces, WhatStandsAskewAtAWholeWallIsNoLeaf) {
    RoomWithSurfaces room;
    room.add(Vector3d::Zero(), 0.0, 4.0, ceiling, everywhere);
    room.add(Vector3d(0.0, 1.52, 0.0), 25.0, 0.85, 1.98, everywhere);
    EXPECT_EQ(room.find().size(), 2U);
}

TEST(WallFaces, AFaceAsNarrowAsAWardrobeIsDeepReachesFromFloorToCeiling) {
    for (const auto& [width, height, count] :
         {std::tuple(0.6, 2.15, 0U), std::tuple(0.6, ceiling, 1U), std::tuple(0.9, 2.15, 1U)}) {
        RoomWithSurfaces room;
        // Where no ceiling was seen.
        room.plan.rooms[0] = {0.0, ceiling, ceiling};
        if (height < ceiling) {
            room.plan.rooms[0] = {0.0, std::nullopt, std::nullopt};
            for (float& cell : room.plan.ceiling_of_cell)
                cell = std::numeric_limits<float>::quiet_NaN();
        }
        room.add(Vector3d(0.0, 1.0, 0.0), 0.0, width, height, everywhere);
        EXPECT_EQ(room.find().size(), count) << width << " x " << height;
    }
}

TEST(WallFaces, WhatEndsBelowTheCeilingOverItDoesNotReachIt) {
    RoomWithSurfaces room;
    // Elsewhere in the room the ceiling hangs lower.
    room.plan.rooms[0].lowest_ceiling = 2.2;
    room.add(Vector3d(0.0, 0.0, 0.0), 0.0, 4.0, 2.15, everywhere);
    std::vector<WallFace> faces = room.find();
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_FALSE(faces[0].reaches_ceiling);

    for (float& height : room.plan.ceiling_of_cell)
        height = std::numeric_limits<float>::quiet_NaN();
    faces = room.find();
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_TRUE(faces[0].reaches_ceiling) << "the room's lowest, where none was seen over it";
}

TEST(WallFaces, AKneeWallReachesTheSlopeOverIt) {
    // Of the second the foot is hidden; the third stands under a level ceiling, as a sideboard
    // does.
    for (const auto& [bottom, is_under_slope, count] :
         {std::tuple(0.0, true, 1U), std::tuple(0.45, true, 1U), std::tuple(0.0, false, 0U)}) {
        RoomWithSurfaces room;
        if (is_under_slope) {
            for (std::size_t cell = 0; cell < room.plan.num_cells(); ++cell) {
                const double slope = 0.8 + room.plan.middle_of(cell).x();
                room.plan.ceiling_of_cell[cell] = static_cast<float>(std::min(slope, ceiling));
                room.plan.is_under_slope[cell] = slope < ceiling;
            }
        }
        room.add(Vector3d::Zero(), 0.0, 4.0, 0.8,
                 [from = bottom](double /*along*/, double z) { return z > from; });
        const std::vector<WallFace> faces = room.find();
        ASSERT_EQ(faces.size(), count) << bottom << ' ' << is_under_slope;
        for (const WallFace& face : faces)
            EXPECT_TRUE(face.reaches_ceiling);
    }
}

TEST(WallFaces, WhatPartsTwoRoomsIsAWallThoughItsTopWasNotSeen) {
    for (const auto& [is_room_behind, height, count] :
         {std::tuple(true, 2.1, 1U), std::tuple(false, 2.1, 0U), std::tuple(true, 1.7, 0U)}) {
        RoomWithSurfaces room;
        room.plan.rooms.push_back({0.0, ceiling, ceiling});
        for (std::size_t cell = 0; cell < room.plan.num_cells(); ++cell) {
            if (room.plan.middle_of(cell).x() > -0.05) continue;
            room.plan.has_level[cell] = true;
            if (is_room_behind) room.plan.room_of_cell[cell] = 1;
        }
        room.add(Vector3d::Zero(), 0.0, 4.0, height, everywhere);
        EXPECT_EQ(room.find().size(), count) << is_room_behind << ' ' << height;
    }
}

}  // namespace
}  // namespace roomscribe
