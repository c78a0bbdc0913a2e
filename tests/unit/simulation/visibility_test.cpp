// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/visibility.hpp"

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "simple_worlds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Shares of all components seen by a terrestrial scanner at the origin, or at `stations`.
std::vector<double> shares(const SimulatedWorld& world, std::vector<Station> stations = {{}},
                           std::size_t points = 1000) {
    Scene scene = world.scene;
    const std::vector<std::size_t> counts(scene.components.size(), points);
    measure_visibility(scene, RayCaster(world), ScannerKind::terrestrial, 1.0, stations, counts);
    std::vector<double> result;
    for (const Component& component : scene.components)
        result.push_back(component.visible.value());
    return result;
}

std::int32_t add_named(SimulatedWorld& world, Label label, std::vector<Vector3d> polygon = {},
                       const std::string& parent = {}) {
    Component component;
    component.label = label;
    component.polygon = std::move(polygon);
    component.parent = parent;
    return add_component(world, std::move(component));
}

/// A board across the x axis at x = 1 that hides all of y > 0.
void add_board(SimulatedWorld& world) {
    add_quad(world, add_clutter_part(world, Material::paint), {1, 0, -9}, {1, 9, -9}, {1, 9, 9},
             {1, 0, 9});
}

TEST(Visibility, OfAHalfHiddenWallIsAHalf) {
    SimulatedWorld world;
    test::add_screen(world, 3.0, Material::paint, 1.0);
    EXPECT_EQ(shares(world).front(), 1.0);
    add_board(world);
    EXPECT_NEAR(shares(world).front(), 0.5, 0.03);
}

TEST(Visibility, TakesTheBestOfAllStations) {
    SimulatedWorld world;
    test::add_screen(world, 3.0, Material::paint, 1.0);
    add_board(world);
    const Station beyond{.at = {1.5, 1.0, 0.0}};
    EXPECT_EQ(shares(world, {{}, beyond}).front(), 1.0);
    EXPECT_EQ(shares(world, {}).front(), 0.0);
}

TEST(Visibility, IsNotHinderedByGlass) {
    SimulatedWorld world;
    test::add_screen(world, 3.0, Material::paint, 1.0);
    const std::uint32_t pane = add_clutter_part(world, Material::glass);
    world.parts[pane].transparency = 0.9;
    add_quad(world, pane, {1, -9, -9}, {1, 9, -9}, {1, 9, 9}, {1, -9, 9});
    EXPECT_EQ(shares(world).front(), 1.0);
}

TEST(Visibility, EndsWithTheFieldOfView) {
    SimulatedWorld world;
    // Right below the scanner, within its blind cone (27.5 degrees about the vertical).
    test::add_surface(world, Label::floor, Material::paint,
                      {{-0.4, -0.4, -1.5}, {0.4, -0.4, -1.5}, {0.4, 0.4, -1.5}, {-0.4, 0.4, -1.5}});
    test::add_screen(world, 130.0, Material::paint, 1.0);  // out of range
    EXPECT_EQ(shares(world), (std::vector{0.0, 0.0}));
}

TEST(Visibility, OfAnOpenDoorIsThatOfItsPolygon) {
    SimulatedWorld world;
    const std::int32_t door =
        add_named(world, Label::door, {{3, -1, -1}, {3, 1, -1}, {3, 1, 1}, {3, -1, 1}});
    // The leaf stands open behind, where it is not seen.
    add_quad(world, add_part(world, door, Material::wood), {3, 5, -1}, {4, 5, -1}, {4, 5, 1},
             {3, 5, 1});
    EXPECT_EQ(shares(world, {{}}, 0).front(), 1.0);
    add_board(world);
    EXPECT_NEAR(shares(world, {{}}, 0).front(), 0.5, 0.03);
}

TEST(Visibility, OfAPieceIsNotHinderedByItselfOrItsFaces) {
    SimulatedWorld world;
    const std::int32_t piece = add_named(world, Label::furniture);
    add_box(world, add_part(world, piece, Material::wood), Transform::Identity(), {3, -1, -1},
            {3.6, 1, 1});
    const std::int32_t face = add_named(
        world, Label::furniture, {{2.98, -1, -1}, {2.98, 1, -1}, {2.98, 1, 1}, {2.98, -1, 1}},
        world.scene.components.front().id);
    add_box(world, add_part(world, face, Material::wood), Transform::Identity(), {2.98, -1, -1},
            {3.0, 1, 1});
    EXPECT_EQ(shares(world), (std::vector{1.0, 1.0}));
    // From behind the piece is seen, the face is not.
    EXPECT_EQ(shares(world, {{.at = {6, 0, 0}}}), (std::vector{1.0, 0.0}));
}

TEST(Visibility, LeavesOutWhereFurnitureTouches) {
    SimulatedWorld world;
    const std::int32_t piece = add_named(world, Label::furniture);
    add_box(world, add_part(world, piece, Material::wood), Transform::Identity(), {3, -1, -1},
            {3.6, 1, 1});
    // Neighbours all round, coinciding with it, and a wall at its back: the front counts.
    const std::uint32_t other = add_clutter_part(world, Material::wood);
    add_box(world, other, Transform::Identity(), {3, 1, -1}, {3.6, 3, 1});
    add_box(world, other, Transform::Identity(), {3, -3, -1}, {3.6, -1, 1});
    add_box(world, other, Transform::Identity(), {3, -3, 1}, {3.6, 3, 2});
    add_box(world, other, Transform::Identity(), {3, -3, -2}, {3.6, 3, -1});
    test::add_screen(world, 3.61, Material::paint);
    // So does a box flush with the right half of its front; the left half is all that is left.
    add_box(world, other, Transform::Identity(), {2.5, 0, -1}, {3, 1, 1});
    EXPECT_GT(shares(world).front(), 0.97);
    add_board(world);
    EXPECT_GT(shares(world).front(), 0.97);
    EXPECT_LT(shares(world, {{.at = {0, 2, 0}}}).front(), 0.97);  // behind that board
}

TEST(Visibility, OfAFrameIsThatOfItsBetterSide) {
    SimulatedWorld world;
    const std::int32_t frame =
        add_named(world, Label::door_frame, {{3, -1, -1}, {3, 1, -1}, {3, 1, 1}, {3, -1, 1}});
    const std::uint32_t part = add_part(world, frame, Material::wood);
    add_box(world, part, Transform::Identity(), {2.98, -1, -1}, {3.12, -0.9, 1});
    add_box(world, part, Transform::Identity(), {2.98, 0.9, -1}, {3.12, 1, 1});
    // The wall that it sits in hides its far side.
    test::add_screen(world, 3.0, Material::paint);
    EXPECT_EQ(shares(world).front(), 1.0);
}

TEST(Visibility, IsBelowWhatCountsWithFewerThanTenPoints) {
    SimulatedWorld world;
    test::add_screen(world, 3.0, Material::paint, 1.0);
    EXPECT_NEAR(shares(world, {{}}, 4).front(), 0.12, 1e-12);
    EXPECT_NEAR(shares(world, {{}}, 10).front(), 0.3, 1e-12);
    EXPECT_EQ(shares(world, {{}}, 40).front(), 1.0);
}

TEST(Visibility, WantsAPointCountForEveryComponent) {
    SimulatedWorld world;
    test::add_screen(world, 3.0, Material::paint, 1.0);
    Scene scene = world.scene;
    EXPECT_THROW(measure_visibility(scene, RayCaster(world), ScannerKind::terrestrial, 1.0, {}, {}),
                 InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
