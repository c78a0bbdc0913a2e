// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/door_outlines.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

/// m before the wall, of what a scanner sees at a place; nothing where it sees none.
using Relief = std::function<std::optional<double>(double, double)>;

constexpr WallRectangle wall{0.0, 4.0, 0.0, 2.6};

/// A wall scanned with a point per 2 cm and normal noise.
std::vector<FacePlace> scan(const Relief& relief, double noise = 0.003) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(0.0, 0.02);
    std::normal_distribution<double> error(0.0, noise);
    std::vector<FacePlace> points;
    for (double x = wall.start; x < wall.end; x += 0.02) {
        for (double z = wall.bottom; z < wall.top; z += 0.02) {
            const double along = x + jitter(random);
            const double above = z + jitter(random);
            const auto height = relief(along, above);
            if (!height) continue;
            points.push_back({static_cast<float>(along), static_cast<float>(above),
                              static_cast<float>(-*height + error(random))});
        }
    }
    std::shuffle(points.begin(), points.end(), random);
    return points;
}

bool is_in(const WallRectangle& area, double x, double z) {
    return x > area.start && x < area.end && z > area.bottom && z < area.top;
}

constexpr WallRectangle leaf{1.5, 2.36, 0.0, 1.985};

/// A leaf 3 mm behind its wall in a steel frame of 5 cm that stands out by 7 mm.
std::optional<double> flush_door(double x, double z) {
    if (is_in(leaf, x, z)) return -0.003;
    return is_in(leaf.grown(0.05, 0.0, 0.05), x, z) ? 0.007 : 0.0;
}

std::vector<DoorOutline> outlines_of(const Relief& relief, double noise = 0.003) {
    return find_door_outlines(scan(relief, noise), wall);
}

void expect_outline(const std::vector<DoorOutline>& outlines, const WallRectangle& border) {
    ASSERT_EQ(outlines.size(), 1U);
    // Either edge of the casing.
    EXPECT_NEAR(outlines[0].border.start, border.start, 0.06);
    EXPECT_NEAR(outlines[0].border.end, border.end, 0.06);
    EXPECT_NEAR(outlines[0].border.top, border.top, 0.06);
    EXPECT_GE(outlines[0].contrast, 1.0);
}

TEST(DoorOutlines, CasingsNarrowerThanAnyCellAreFound) {
    expect_outline(outlines_of(flush_door), leaf);
}

TEST(DoorOutlines, TheBorderIsToldBelowTheNoiseOfAPoint) {
    expect_outline(outlines_of(flush_door, 0.008), leaf);
}

TEST(DoorOutlines, WhatIsInsideDoesNotMatter) {
    const WallRectangle lower{1.62, 2.24, 0.2, 0.97};
    const WallRectangle upper{1.62, 2.24, 1.07, 1.87};
    expect_outline(outlines_of([&](double x, double z) -> std::optional<double> {
                       if (is_in(lower, x, z) || is_in(upper, x, z)) return std::nullopt;
                       return is_in(leaf.grown(0.05, 0.0, 0.05), x, z) ? 0.01 : 0.0;
                   }),
                   leaf.grown(0.05, 0.0, 0.05));
}

TEST(DoorOutlines, ARecessedFrameStepsIntoTheWall) {
    const auto outlines = outlines_of([](double x, double z) -> std::optional<double> {
        return is_in(leaf, x, z) ? -0.02 : 0.0;
    });
    expect_outline(outlines, leaf);
    EXPECT_NEAR(outlines.at(0).step, -0.02, 0.003);
    EXPECT_NEAR(outlines.at(0).inside, -0.02, 0.003);
}

TEST(DoorOutlines, TheyAreTheSameInAnyOrderOfThePoints) {
    std::vector<FacePlace> points = scan(flush_door);
    const auto outlines = find_door_outlines(points, wall);
    std::reverse(points.begin(), points.end());
    const auto reversed = find_door_outlines(points, wall);
    ASSERT_EQ(outlines.size(), 1U);
    ASSERT_EQ(reversed.size(), 1U);
    EXPECT_EQ(outlines[0].border.start, reversed[0].border.start);
    EXPECT_EQ(outlines[0].border.top, reversed[0].border.top);
    EXPECT_EQ(outlines[0].step, reversed[0].step);
}

/// Whatever is in a wall that is no door.
void expect_none(const Relief& relief) {
    EXPECT_TRUE(outlines_of(relief).empty());
}

TEST(DoorOutlines, PlainWallHasNone) {
    expect_none([](double, double) { return 0.0; });
}

TEST(DoorOutlines, BoardsHangAboveTheFloor) {
    expect_none([](double x, double z) -> std::optional<double> {
        return is_in({1.5, 2.4, 0.7, 2.0}, x, z) ? 0.02 : 0.0;
    });
}

TEST(DoorOutlines, PillarsGoOnAboveALintelsHeight) {
    expect_none([](double x, double z) -> std::optional<double> {
        return is_in({1.5, 2.4, 0.0, 2.6}, x, z) ? 0.03 : 0.0;
    });
}

TEST(DoorOutlines, BookcasesAreHigherThanDoors) {
    expect_none([](double x, double z) -> std::optional<double> {
        return is_in({1.5, 2.4, 0.0, 2.45}, x, z) ? 0.03 : 0.0;
    });
}

TEST(DoorOutlines, CurtainsHaveWallBetweenThem) {
    expect_none([](double x, double z) -> std::optional<double> {
        if (is_in({1.75, 2.15, 0.9, 1.9}, x, z)) return std::nullopt;
        const bool is_curtain =
            is_in({1.4, 1.7, 0.0, 2.05}, x, z) || is_in({2.2, 2.5, 0.0, 2.05}, x, z);
        return is_curtain || is_in({1.4, 2.5, 1.95, 2.05}, x, z) ? 0.03 : 0.0;
    });
}

TEST(DoorOutlines, WallThatNobodySawAboveTellsNothing) {
    expect_none([](double x, double z) -> std::optional<double> {
        if (z > 2.0) return std::nullopt;
        return flush_door(x, z);
    });
}

TEST(DoorOutlines, NothingIsReadOffAFewPoints) {
    EXPECT_TRUE(find_door_outlines({}, wall).empty());
    const FacePlace point{1.0F, 1.0F, 0.0F};
    EXPECT_TRUE(find_door_outlines({&point, 1}, wall).empty());
}

}  // namespace
}  // namespace roomscribe
