// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/building/building.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/scanning/ray_caster.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Two rooms side by side, 0.2 m of wall between them, 2.5 m high.
Scenario two_rooms() {
    Scenario scenario;
    scenario.rooms = {
        {.name = "left", .use = "office", .outline = {{0, 0}, {4, 0}, {4, 3}, {0, 3}}},
        {.name = "right", .use = "office", .outline = {{4.2, 0}, {7, 0}, {7, 3}, {4.2, 3}}}};
    for (RoomPlan& room : scenario.rooms)
        room.ceiling_height = 2.5;
    return scenario;
}

OpeningPlan door_between() {
    OpeningPlan door;
    door.kind = OpeningKind::door;
    door.room = "left";
    door.at = {4.0, 1.5};
    door.width = 0.9;
    door.height = 2.0;
    door.frame_width = 0.05;
    door.frame_protrusion = 0.02;
    door.recess = 0.03;
    return door;
}

SimulatedWorld world_of(const Scenario& scenario) {
    SimulatedWorld world;
    add_building(world, scenario);
    return world;
}

std::vector<const Component*> components_of(const SimulatedWorld& world, Label label) {
    std::vector<const Component*> found;
    for (const Component& component : world.scene.components) {
        if (component.label == label) found.push_back(&component);
    }
    return found;
}

/// Shares of rays from a point, in all directions, by the label that they hit first.
std::array<double, num_labels> hits_by_label(const SimulatedWorld& world, const Vector3d& origin) {
    const RayCaster caster(world);
    Random random(3);
    std::array<double, num_labels> shares{};
    constexpr int num_rays = 20000;
    for (int i = 0; i < num_rays; ++i) {
        const auto hit = caster.cast(origin, test::random_direction(random));
        if (!hit) {
            ADD_FAILURE() << "a ray gets out";
            continue;
        }
        shares[static_cast<std::size_t>(world.parts[hit->part].label)] += 1.0 / num_rays;
    }
    return shares;
}

TEST(Building, AClosedRoomIsTight) {
    Scenario scenario = two_rooms();
    scenario.openings = {door_between()};
    const SimulatedWorld world = world_of(scenario);
    const RayCaster caster(world);
    Random random(4);
    int num_through_gap = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vector3d direction = test::random_direction(random);
        const auto hit = caster.cast({2.0, 1.5, 1.2}, direction);
        ASSERT_TRUE(hit.has_value());
        const Vector3d point = Vector3d(2.0, 1.5, 1.2) + hit->distance * direction;
        EXPECT_TRUE(point.x() > -0.01 && point.y() > -0.01 && point.y() < 3.01 &&
                    point.z() > -1e-4 && point.z() < 2.5001)
            << point.transpose();
        // Behind the leaf one looks only through the 3 mm around it.
        num_through_gap += point.x() > 4.035 ? 1 : 0;
    }
    EXPECT_LT(num_through_gap, 20);
}

TEST(Building, WhatIsSeenFromTheMiddleIsWhatTheSolidAnglesSay) {
    Scenario scenario = two_rooms();
    scenario.rooms.pop_back();
    scenario.rooms[0].outline = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
    scenario.rooms[0].ceiling_height = 3.0;
    scenario.rooms[0].use = "bath";  // No skirting.
    const auto shares = hits_by_label(world_of(scenario), {1.5, 1.5, 1.5});
    EXPECT_NEAR(shares[static_cast<std::size_t>(Label::floor)], 1.0 / 6.0, 0.01);
    EXPECT_NEAR(shares[static_cast<std::size_t>(Label::ceiling)], 1.0 / 6.0, 0.01);
    EXPECT_NEAR(shares[static_cast<std::size_t>(Label::wall)], 4.0 / 6.0, 0.012);
}

TEST(Building, AnOpenDoorLeadsIntoTheNextRoom) {
    Scenario scenario = two_rooms();
    scenario.openings = {door_between()};
    scenario.openings[0].leaf = LeafState::open;
    scenario.openings[0].leaf_angle = 90.0;
    scenario.openings[0].opens_into_room = false;
    const SimulatedWorld world = world_of(scenario);
    const RayCaster caster(world);
    const auto hit = caster.cast({1.0, 1.5, 1.2}, Vector3d::UnitX());
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance, 6.0, 0.01);
    ASSERT_EQ(world.scene.rooms[0].neighbors.size(), 1U);
    EXPECT_EQ(world.scene.rooms[0].neighbors[0].room, "right");
    EXPECT_EQ(world.scene.rooms[1].neighbors[0].through, world.scene.rooms[0].neighbors[0].through);
}

TEST(Building, ADoorStandsWhereThePlanSays) {
    Scenario scenario = two_rooms();
    scenario.openings = {door_between()};
    const SimulatedWorld world = world_of(scenario);
    const auto doors = components_of(world, Label::door);
    const auto frames = components_of(world, Label::door_frame);
    ASSERT_EQ(doors.size(), 1U);
    ASSERT_EQ(frames.size(), 1U);
    ASSERT_EQ(doors[0]->polygon.size(), 4U);
    // The leaf lies 3 cm behind the face at x = 4 and is 4 cm thick.
    for (const Vector3d& corner : doors[0]->polygon)
        EXPECT_NEAR(corner.x(), 4.0 + 0.03 + 0.02, 1e-9);
    const double width = (doors[0]->polygon[1] - doors[0]->polygon[0]).norm();
    EXPECT_NEAR(width, 0.9 - 2 * 0.003, 1e-9);
    const double outer_width = (frames[0]->polygon[1] - frames[0]->polygon[0]).norm();
    const double outer_height = (frames[0]->polygon[2] - frames[0]->polygon[1]).norm();
    EXPECT_NEAR(outer_width, 0.9 + 2 * 0.05, 1e-9);
    EXPECT_NEAR(outer_height, 2.0 + 0.05, 1e-9);

    // The casing stands 2 cm out of the face.
    const RayCaster caster(world);
    const auto casing = caster.cast({2.0, 1.5 + 0.475, 1.0}, Vector3d::UnitX());
    ASSERT_TRUE(casing.has_value());
    EXPECT_NEAR(casing->distance, 2.0 - 0.02, 1e-5);
    EXPECT_EQ(world.parts[casing->part].label, Label::door_frame);
    const auto leaf = caster.cast({2.0, 1.5, 1.0}, Vector3d::UnitX());
    ASSERT_TRUE(leaf.has_value());
    EXPECT_NEAR(leaf->distance, 2.03, 1e-5);
    EXPECT_EQ(world.parts[leaf->part].label, Label::door);
}

TEST(Building, ALeverSitsOnEachSideOfTheLeafAwayFromTheHinge) {
    Scenario scenario = two_rooms();
    scenario.openings = {door_between()};
    const SimulatedWorld world = world_of(scenario);
    const auto levers = components_of(world, Label::handle);
    ASSERT_EQ(levers.size(), 2U);
    for (const Component* lever : levers) {
        EXPECT_EQ(lever->parent, components_of(world, Label::door)[0]->id);
        ASSERT_TRUE(lever->grasp.has_value());
        EXPECT_NEAR(std::abs(lever->grasp->approach.x()), 1.0, 1e-9);
        EXPECT_NEAR(lever->grasp->position.z(), 1.05, 1e-9);
        const auto& axes = lever->box->axes;
        EXPECT_NEAR(axes[0].cross(axes[1]).dot(axes[2]), 1.0, 1e-9) << "left-handed";
        // Hinged left as seen from the room: along the face at x = 4 that is towards +y.
        EXPECT_LT(lever->grasp->position.y(), 1.5);
    }
    EXPECT_LT(levers[0]->grasp->position.x(), 4.03);
    EXPECT_GT(levers[1]->grasp->position.x(), 4.07);
}

TEST(Building, AWindowIsEmbeddedAndItsGlassIsGlass) {
    Scenario scenario = two_rooms();
    OpeningPlan window;
    window.kind = OpeningKind::window;
    window.room = "left";
    window.at = {2.0, 0.0};
    window.width = 1.2;
    window.height = 1.0;
    window.sill = 0.9;
    window.frame_width = 0.08;
    window.recess = 0.1;
    scenario.openings = {window};
    const SimulatedWorld world = world_of(scenario);
    const Component& pane = *components_of(world, Label::window).at(0);
    const Component& frame = *components_of(world, Label::window_frame).at(0);
    EXPECT_NEAR((pane.polygon[1] - pane.polygon[0]).norm(), 1.2 - 2 * 0.08, 1e-9);
    EXPECT_NEAR((frame.polygon[1] - frame.polygon[0]).norm(), 1.2, 1e-9);
    for (const Vector3d& corner : frame.polygon)
        EXPECT_NEAR(corner.y(), -0.1, 1e-9);

    const RayCaster caster(world);
    const auto glass = caster.cast({2.0, 1.5, 1.4}, -Vector3d::UnitY());
    ASSERT_TRUE(glass.has_value());
    EXPECT_EQ(world.parts[glass->part].material, Material::glass);
    EXPECT_EQ(world.parts[glass->part].label, Label::window);
    const auto jamb = caster.cast({1.44, 1.5, 1.4}, -Vector3d::UnitY());
    ASSERT_TRUE(jamb.has_value());
    EXPECT_EQ(world.parts[jamb->part].label, Label::window_frame);
    EXPECT_NEAR(jamb->distance, 1.6, 1e-5);
}

TEST(Building, WallsAreOnlyAsUnevenAsFinishedWalls) {
    Scenario scenario = two_rooms();
    const SimulatedWorld world = world_of(scenario);
    double greatest = 0.0;
    for (std::size_t i = 0; i < world.triangles.size(); ++i) {
        const WorldPart& part = world.parts[world.part_of_triangle[i]];
        if (part.component < 0 || part.label != Label::wall ||
            part.acceptable != label_bit(Label::wall))
            continue;
        const Component& wall = world.scene.components[static_cast<std::size_t>(part.component)];
        const Vector3d normal = (wall.polygon[1] - wall.polygon[0])
                                    .cross(wall.polygon[2] - wall.polygon[0])
                                    .normalized();
        for (const std::uint32_t vertex : world.triangles[i]) {
            greatest = std::max(
                greatest,
                std::abs(normal.dot(world.vertices[vertex].cast<double>() - wall.polygon[0])));
        }
    }
    EXPECT_GT(greatest, 0.0005);
    EXPECT_LE(greatest, 0.0025 + 1e-6);
}

TEST(Building, RefusesWhatCannotBeBuilt) {
    Scenario scenario = two_rooms();
    std::reverse(scenario.rooms[0].outline.begin(), scenario.rooms[0].outline.end());
    EXPECT_THROW(world_of(scenario), InvalidArgument);
    scenario = two_rooms();
    scenario.openings = {door_between()};
    scenario.openings[0].at = {3.0, 1.5};
    EXPECT_THROW(world_of(scenario), InvalidArgument);
    scenario.openings[0].at = {4.0, 0.1};  // It would reach into the corner.
    EXPECT_THROW(world_of(scenario), InvalidArgument);
    EXPECT_THROW(world_of({}), InvalidArgument);
}

TEST(WallLayout, FindsTheFaceBehindAFace) {
    const Scenario scenario = two_rooms();
    const std::vector<BuiltWallFace> faces = wall_faces(scenario.rooms);
    const auto far = find_far_face(faces, 1, {4.0, 1.0});
    ASSERT_TRUE(far.has_value());
    EXPECT_EQ(faces[far->face].room, 1U);
    EXPECT_NEAR(far->thickness, 0.2, 1e-12);
    EXPECT_FALSE(find_far_face(faces, 0, {2.0, 0.0}).has_value());
}

TEST(WallLayout, TellsInsideFromOutside) {
    const std::vector<Vector2d> outline{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}};
    EXPECT_TRUE(contains(outline, {1.0, 3.0}));
    EXPECT_TRUE(contains(outline, {3.0, 1.0}));
    EXPECT_FALSE(contains(outline, {3.0, 3.0}));
    EXPECT_FALSE(contains(outline, {-0.1, 1.0}));
}

}  // namespace
}  // namespace roomscribe
