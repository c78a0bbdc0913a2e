// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/floor_plan.hpp"

#include <gtest/gtest.h>

#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/interpretation/rooms/room_outline.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

/// A plan of 5 x 4 m in cells of 10 cm whose room 0 has an L shape: 3 x 2 m without 1 x 1 m.
FloorPlan l_shaped_plan() {
    FloorPlan plan(Vector2d(-1.0, 0.0), Vector2d(4.0, 4.0), 0.1);
    for (std::size_t cell = 0; cell < plan.num_cells(); ++cell) {
        const Vector2d place = plan.middle_of(cell);
        const bool is_in = place.x() > 0.0 && place.x() < 3.0 && place.y() > 1.0 &&
                           place.y() < 3.0 && !(place.x() > 2.0 && place.y() > 2.0);
        if (is_in) plan.room_of_cell[cell] = 0;
    }
    plan.rooms.emplace_back();
    return plan;
}

TEST(FloorPlan, KnowsItsCells) {
    const FloorPlan plan = l_shaped_plan();
    for (std::size_t cell = 0; cell < plan.num_cells(); cell += 7)
        EXPECT_EQ(plan.cell_at(plan.middle_of(cell)), cell);
    EXPECT_FALSE(plan.cell_at(Vector2d(-1.01, 1.0)).has_value());
    EXPECT_FALSE(plan.cell_at(Vector2d(0.0, 4.2)).has_value());
    EXPECT_EQ(plan.room_at(Vector2d(0.5, 1.5)), 0);
    EXPECT_EQ(plan.room_at(Vector2d(2.5, 2.5)), no_room);
    EXPECT_EQ(plan.room_at(Vector2d(50.0, 0.0)), no_room);
    EXPECT_EQ(FloorPlan().room_at(Vector2d(0.0, 0.0)), no_room);
}

TEST(TraceRoom, FollowsTheRimOfAnLShape) {
    const std::vector<Vector2d> outline = trace_room(l_shaped_plan(), 0);
    EXPECT_EQ(outline.size(), 6U);
    EXPECT_NEAR(signed_area(outline), 5.0, 1e-9);
    EXPECT_TRUE(trace_room(l_shaped_plan(), 3).empty());
}

TEST(TraceRoom, LeavesOutHoles) {
    FloorPlan plan = l_shaped_plan();
    plan.room_of_cell[*plan.cell_at(Vector2d(1.05, 1.55))] = no_room;
    EXPECT_NEAR(signed_area(trace_room(plan, 0)), 5.0, 1e-9);
}

}  // namespace
}  // namespace roomscribe
