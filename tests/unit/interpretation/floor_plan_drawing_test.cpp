// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/floor_plan_drawing.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr double step = 0.04;  // m, between voxels

/// A room of 4 x 4 m with a scanner, and a doorway from x = 1.5 to 2.5 m in its wall y = 0; beyond
/// it level ground, of which the scanner sees what the jambs let it. No ceiling was seen.
struct ViewThroughADoor {
    SurfaceSample sample;
    std::vector<PlanarPatch> patches;
    std::vector<UprightSurface> surfaces;
    std::vector<Ray> rays;
    Storey storey;
    Vector3d scanner{2.0, 2.0, 1.5};

    ViewThroughADoor() {
        sample.spacing = step;
        sample.voxel_size = step;
        sample.tolerance = 0.02;
        sample.normals_face_scanner = true;
        sample.sensor_positions = {scanner};
        PlanarPatch floor;
        for (double x = 0.02; x < 4.0; x += step) {
            for (double y = -1.98; y < 4.0; y += step) {
                // At y the door's jambs leave twice 0.5 m per 2 m from the scanner.
                if (y < 0.0 && std::abs(x - 2.0) > 0.25 * (2.0 - y)) continue;
                add(floor, {x, y, 0.0});
            }
        }
        storey.floor = Level{0.0, 20.0, 20.0, {0}};
        patches.push_back(floor);
        for (const double y : {0.0, 4.0})
            add_wall({0.0, y, 0.0}, Vector3d::UnitX(), 4.0, y == 0.0);
        for (const double x : {0.0, 4.0})
            add_wall({x, 0.0, 0.0}, Vector3d::UnitY(), 4.0, false);
    }

    void add(PlanarPatch& patch, const Vector3d& place) {
        patch.points.push_back(static_cast<std::uint32_t>(sample.cloud.size()));
        sample.cloud.positions.push_back(place.cast<float>());
        rays.push_back({scanner.cast<float>(), place.cast<float>()});
    }
    void add_wall(const Vector3d& foot, const Vector3d& along, double length, bool has_door) {
        PlanarPatch patch;
        for (double a = 0.02; a < length; a += step) {
            if (has_door && a > 1.5 && a < 2.5) continue;
            for (double z = 0.02; z < 2.4; z += step)
                add(patch, foot + a * along + z * Vector3d::UnitZ());
        }
        UprightSurface surface;
        surface.plane.normal = along.cross(Vector3d::UnitZ());
        surface.plane.offset = surface.plane.normal.dot(foot);
        surface.along = along;
        surface.start = foot.dot(along);
        surface.end = surface.start + length;
        surface.top = 2.4;
        surface.patches = {static_cast<std::uint32_t>(patches.size())};
        patches.push_back(patch);
        surfaces.push_back(surface);
    }
    std::size_t num_rooms() const {
        return draw_floor_plan(rays, sample, patches, Eigen::Matrix3d::Identity(), storey, surfaces,
                               {})
            .rooms.size();
    }
};

TEST(FloorPlanDrawing, WhatAWallEndsBehindADoorIsARoom) {
    ViewThroughADoor view;
    view.add_wall({1.0, -2.0, 0.0}, Vector3d::UnitX(), 2.0, false);
    EXPECT_EQ(view.num_rooms(), 2U);
}

TEST(FloorPlanDrawing, WhatNothingEndsBehindADoorIsOutdoors) {
    EXPECT_EQ(ViewThroughADoor().num_rooms(), 1U);
}

}  // namespace
}  // namespace roomscribe
