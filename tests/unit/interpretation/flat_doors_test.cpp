// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/flat_doors.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

constexpr double cell_size = 0.05;

/// A wall of 4 x 2.6 m; `height`: m before its plane, of what is at x, z. Rows from `seen_up_to`
/// on, and all but each `line_spacing`-th, were not seen.
WallRelief wall_with(const std::function<double(double, double)>& height, double seen_up_to = 2.6,
                     int line_spacing = 1) {
    WallRelief relief;
    relief.cell_size = cell_size;
    relief.tolerance = 0.02;
    relief.num_columns = 80;
    relief.num_rows = 52;
    relief.has_rays = true;
    relief.cells.resize(80U * 52U);
    relief.depths.resize(relief.cells.size() * num_depth_bins);
    for (int row = 0; row < relief.num_rows; row += line_spacing) {
        const double z = (row + 0.5) * cell_size;
        if (z > seen_up_to) continue;
        for (int column = 0; column < relief.num_columns; ++column) {
            ReliefCell& cell = relief.cells[relief.index(column, row)];
            cell.surface = cell.near = 4;
            cell.height = static_cast<float>(4.0 * height((column + 0.5) * cell_size, z));
        }
    }
    return relief;
}

/// A leaf 1 cm deep from `start` to `end`, 2 m high, and its casing of 10 cm, 1.5 cm before the
/// wall.
double cased_door(double x, double z, double start, double end) {
    if (x > start && x < end && z < 2.0) return -0.01;
    return x > start - 0.1 && x < end + 0.1 && z < 2.1 ? 0.015 : 0.0;
}

void expect_door(const FlatDoor& door, double start, double end) {
    // To a casing's width: fit_door_sides() moves the edges.
    EXPECT_NEAR(door.cells.left * cell_size, start, 0.11);
    EXPECT_NEAR(door.cells.right * cell_size, end, 0.11);
}

/// The one door of a wall; where there is another number of them, none.
FlatDoor only_door(const WallRelief& wall, double start, double end) {
    const std::vector<FlatDoor> doors = find_flat_doors(wall);
    EXPECT_EQ(doors.size(), 1U);
    if (doors.size() != 1) return {};
    expect_door(doors[0], start, end);
    return doors[0];
}

TEST(FlatDoors, AreFoundByLeafAndCasing) {
    const FlatDoor door = only_door(
        wall_with([](double x, double z) { return cased_door(x, z, 1.5, 2.4); }), 1.5, 2.4);
    EXPECT_NEAR(door.cells.high * cell_size, 2.0, 1.5 * cell_size);
    EXPECT_TRUE(door.has_lintel);
    EXPECT_TRUE(find_flat_doors(wall_with([](double, double) { return 0.0; })).empty());
}

TEST(FlatDoors, NeedNoLintelWhereNobodyLookedUp) {
    const WallRelief wall =
        wall_with([](double x, double z) { return cased_door(x, z, 1.5, 2.4); }, 1.9);
    EXPECT_FALSE(only_door(wall, 1.5, 2.4).has_lintel);
}

TEST(FlatDoors, ShowBetweenTheLinesOfACoarseScanner) {
    only_door(wall_with([](double x, double z) { return cased_door(x, z, 1.5, 2.4); }, 2.6, 3), 1.5,
              2.4);
}

TEST(FlatDoors, StandCloseBesideACorner) {
    only_door(wall_with([](double x, double z) { return cased_door(x, z, 0.2, 1.1); }), 0.2, 1.1);
}

TEST(FlatDoors, AreNotTheWallBetweenThem) {
    const auto doors = find_flat_doors(wall_with(
        [](double x, double z) {
            return x < 1.95 ? cased_door(x, z, 0.7, 1.5) : cased_door(x, z, 2.4, 3.2);
        },
        1.9));
    ASSERT_EQ(doors.size(), 2U);
    for (const FlatDoor& door : doors)
        expect_door(door, door.cells.left < 30 ? 0.7 : 2.4, door.cells.left < 30 ? 1.5 : 3.2);
}

TEST(FlatDoors, HaveACasingWhereTheyHaveTwoLeaves) {
    only_door(wall_with([](double x, double z) { return cased_door(x, z, 1.0, 2.6); }), 1.0, 2.6);
    const auto none = find_flat_doors(
        wall_with([](double x, double z) { return x > 1.0 && x < 2.6 && z < 2.0 ? -0.03 : 0.0; }));
    EXPECT_TRUE(none.empty());
}

/// A rebated leaf 3 cm before the wall from `start` to `end`, 2 m high, over its architrave.
double proud_door(double x, double z, double start, double end) {
    if (x > start && x < end && z < 2.0) return 0.03;
    return x > start - 0.06 && x < end + 0.06 && z < 2.06 ? 0.015 : 0.0;
}

TEST(FlatDoors, StandProudOfTheWallWhereTheyOpenTo) {
    const FlatDoor door = only_door(
        wall_with([](double x, double z) { return proud_door(x, z, 1.5, 2.4); }), 1.5, 2.4);
    EXPECT_NEAR(door.cells.high * cell_size, 2.0, 2.0 * cell_size);
    EXPECT_NEAR(door.height, 0.03, 0.005);
}

TEST(FlatDoors, StandProudWhereACornerHidesASide) {
    only_door(wall_with([](double x, double z) { return proud_door(x, z, 0.07, 0.95); }), 0.07,
              0.95);
}

TEST(FlatDoors, AreNotBoardsPiersNorWardrobes) {
    const auto count = [](double depth, double bottom, double top) {
        return find_flat_doors(wall_with([=](double x, double z) {
                   return x > 1.5 && x < 2.4 && z > bottom && z < top ? depth : 0.0;
               }))
            .size();
    };
    EXPECT_EQ(count(0.03, 0.0, 2.0), 1U);
    EXPECT_EQ(count(0.03, 0.5, 2.0), 0U) << "a board";
    EXPECT_EQ(count(0.03, 0.0, 2.6), 0U) << "a pier";
    EXPECT_EQ(count(0.03, 0.0, 1.6), 0U) << "a low front";
    EXPECT_EQ(count(0.2, 0.0, 2.0), 0U) << "a wardrobe";
}

TEST(FlatDoors, AreNotTheBackOfAShelf) {
    WallRelief relief =
        wall_with([](double x, double z) { return x > 1.5 && x < 2.4 && z < 2.0 ? 0.03 : 0.0; });
    for (int row = 0; row < 40; ++row) {
        for (int column = 30; column < 48; ++column) {
            if ((row + column) % 2 == 0) relief.cells[relief.index(column, row)].standing = 8;
        }
    }
    EXPECT_TRUE(find_flat_doors(relief).empty());
}

/// A corridor's far scans look along the wall and end before it, a door is clear all the same.
TEST(FlatDoors, MayHaveRaysThatEndFarBeforeThem) {
    WallRelief wall = wall_with([](double x, double z) { return proud_door(x, z, 1.5, 2.4); });
    for (ReliefCell& cell : wall.cells)
        cell.hidden = 8;
    only_door(wall, 1.5, 2.4);
}

/// Far away only each third line is seen.
TEST(FlatDoors, AreSeenAsWellAsTheWallNearby) {
    WallRelief wall = wall_with([](double x, double z) { return cased_door(x, z, 2.7, 3.6); });
    for (int row = 0; row < wall.num_rows; ++row) {
        for (int column = 30; column < wall.num_columns; ++column) {
            if (row % 3 != 0) wall.cells[wall.index(column, row)] = {};
        }
    }
    only_door(wall, 2.7, 3.6);
}

/// A leaf 4 mm before the wall, with a lever of 12 cm that fills a fifth of its cells.
double leaf_with(double x, double z, double lever_height) {
    if (x > 1.65 && x < 1.77 && std::abs(z - lever_height) < 0.05) return 0.014;
    return x > 1.5 && x < 2.4 && z < 2.0 ? 0.004 : 0.0;
}

TEST(FlatDoors, NeedHalfTheStepWhereTheyHaveALever) {
    only_door(wall_with([](double x, double z) { return leaf_with(x, z, 1.05); }), 1.5, 2.4);
    const auto at_knees = [](double x, double z) { return leaf_with(x, z, 0.5); };
    EXPECT_TRUE(find_flat_doors(wall_with(at_knees)).empty());
    const auto without = [](double x, double z) { return std::min(leaf_with(x, z, 1.05), 0.004); };
    EXPECT_TRUE(find_flat_doors(wall_with(without)).empty());
    const auto rough = [](double x, double z) {
        const bool is_bump = x > 1.9 && x < 2.1 && z > 1.3 && z < 1.7;
        return leaf_with(x, z, 1.05) + (is_bump ? 0.012 : 0.0);
    };
    EXPECT_TRUE(find_flat_doors(wall_with(rough)).empty());
}

/// A board ends above the desk that hides what is below; without rays nobody knows what does.
TEST(FlatDoors, StandProudWhereTheFloorEndIsSeen) {
    const auto proud = [](double x, double z) { return proud_door(x, z, 1.5, 2.4); };
    WallRelief behind_desk = wall_with(proud);
    for (int row = 0; row < 14; ++row) {
        for (int column = 0; column < behind_desk.num_columns; ++column)
            behind_desk.cells[behind_desk.index(column, row)] = {};
    }
    EXPECT_TRUE(find_flat_doors(behind_desk).empty());
    WallRelief of_unknown_scanner = wall_with(proud);
    of_unknown_scanner.has_rays = false;
    EXPECT_EQ(find_flat_doors(of_unknown_scanner).size(), 1U);
}

}  // namespace
}  // namespace roomscribe
