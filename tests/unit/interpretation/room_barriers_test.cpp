// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/room_barriers.hpp"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double cell_size = 0.05;
constexpr double ceiling = 2.5;

/// A room of 4 x 2 m, its floor and ceiling seen everywhere, and what stands in it along x = 2 m.
struct RoomWithSurface {
    FloorPlan plan{Vector2d(0.0, 0.0), Vector2d(4.0, 2.0), cell_size};
    std::vector<PlanCell> cells = std::vector<PlanCell>(plan.num_cells());
    SurfaceSample sample;
    std::vector<PlanarPatch> patches = std::vector<PlanarPatch>(1);
    UprightSurface surface;

    /// Surface is where `is_there(y, z)`.
    explicit RoomWithSurface(const std::function<bool(double, double)>& is_there) {
        plan.has_level.assign(plan.num_cells(), true);
        plan.ceiling_of_cell.assign(plan.num_cells(), static_cast<float>(ceiling));
        for (PlanCell& cell : cells)
            cell.has_floor = true;
        surface.plane.normal = Vector3d::UnitX();
        surface.plane.offset = 2.0 + 0.5 * cell_size;
        surface.along = Vector3d::UnitY();
        surface.end = 2.0;
        surface.top = ceiling;
        surface.bottom = ceiling;
        for (double y = 0.01; y < 2.0; y += 0.02) {
            for (double z = 0.01; z < ceiling; z += 0.02) {
                if (!is_there(y, z)) continue;
                patches[0].points.push_back(
                    static_cast<std::uint32_t>(sample.cloud.positions.size()));
                sample.cloud.positions.emplace_back(static_cast<float>(surface.plane.offset),
                                                    static_cast<float>(y), static_cast<float>(z));
                surface.bottom = std::min(surface.bottom, z);
            }
        }
        surface.patches = {0};
    }

    void draw() {
        draw_barriers({&surface, 1}, sample, patches, Eigen::Matrix3d::Identity(), 0.0, {}, plan,
                      cells);
    }
    std::size_t cell_at(double y) const { return *plan.cell_at(Vector2d(surface.plane.offset, y)); }
};

TEST(RoomBarriers, AWallPartsRoomsAlsoOverItsDoor) {
    RoomWithSurface room([](double y, double z) { return y < 0.6 || y > 1.5 || z > 2.0; });
    room.draw();
    for (double y = 0.05; y < 1.95; y += cell_size)
        EXPECT_TRUE(room.plan.is_barrier[room.cell_at(y)]) << y;
    EXPECT_TRUE(room.cells[room.cell_at(0.3)].is_solid);
    EXPECT_FALSE(room.cells[room.cell_at(1.0)].is_solid);
}

TEST(RoomBarriers, ABeamPartsNothing) {
    RoomWithSurface room([](double, double z) { return z > 2.1; });
    room.draw();
    for (std::size_t cell = 0; cell < room.cells.size(); ++cell)
        EXPECT_FALSE(room.plan.is_barrier[cell]) << cell;
}

TEST(RoomBarriers, AWallOverACupboardPartsRooms) {
    RoomWithSurface room([](double, double z) { return z > 2.1; });
    for (PlanCell& cell : room.cells)
        cell.has_floor = false;
    room.draw();
    EXPECT_TRUE(room.plan.is_barrier[room.cell_at(1.0)]);
}

TEST(RoomBarriers, FurniturePartsNothing) {
    RoomWithSurface room([](double, double z) { return z < 1.1; });
    room.surface.top = 1.1;
    room.draw();
    EXPECT_FALSE(room.plan.is_barrier[room.cell_at(1.0)]);
}

/// A second surface along x = 2.6 m, seen from z = `from` on.
void add_surface_behind(RoomWithSurface& room, std::vector<UprightSurface>& surfaces, double from) {
    UprightSurface behind = room.surface;
    behind.plane.offset += 0.6;
    behind.top = ceiling;
    behind.bottom = from;
    behind.patches = {1};
    room.patches.emplace_back();
    for (double y = 0.01; y < 2.0; y += 0.02) {
        for (double z = from; z < ceiling; z += 0.02) {
            room.patches[1].points.push_back(
                static_cast<std::uint32_t>(room.sample.cloud.positions.size()));
            room.sample.cloud.positions.emplace_back(static_cast<float>(behind.plane.offset),
                                                     static_cast<float>(y), static_cast<float>(z));
        }
    }
    surfaces = {room.surface, behind};
}

TEST(RoomBarriers, WithoutScannersAPartitionUnderTheCeilingPartsRooms) {
    RoomWithSurface room([](double, double z) { return z < 2.15; });
    room.surface.top = 2.15;
    room.draw();
    EXPECT_TRUE(room.plan.is_barrier[room.cell_at(1.0)]);
}

TEST(RoomBarriers, WithoutScannersAWardrobeBeforeAWallPartsNothing) {
    RoomWithSurface room([](double, double z) { return z < 2.0; });
    room.surface.top = 2.0;
    // It stands on the floor, up to the wall.
    for (std::size_t cell = 0; cell < room.cells.size(); ++cell)
        room.cells[cell].has_floor = room.plan.middle_of(cell).x() < 2.0;
    std::vector<UprightSurface> surfaces;
    add_surface_behind(room, surfaces, 2.0);
    draw_barriers(surfaces, room.sample, room.patches, Eigen::Matrix3d::Identity(), 0.0, {},
                  room.plan, room.cells);
    EXPECT_FALSE(room.plan.is_barrier[room.cell_at(1.0)]);
    EXPECT_TRUE(room.plan.is_barrier[*room.plan.cell_at(Vector2d(2.6 + 0.5 * cell_size, 1.0))]);
}

}  // namespace
}  // namespace roomscribe
