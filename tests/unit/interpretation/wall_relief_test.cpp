// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/wall_relief.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/interpretation/openings/wall_holes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// A wall of 4 x 2.4 m in the plane x = 0 that looks along x.
WallFace wall() {
    WallFace face;
    face.room = 0;
    face.plane = {Vector3d::UnitX(), 0.0};
    face.along = Vector3d::UnitY();
    face.start = 0.0;
    face.end = 4.0;
    return face;
}

/// A ray from the scanner through (0, y, z) that ends at x.
void add_ray(ScanMap& map, const Vector3d& sensor, double y, double z, double x) {
    const Vector3d direction = Vector3d(0.0, y, z) - sensor;
    const Vector3d end = sensor + (sensor.x() - x) / sensor.x() * direction;
    map.cloud.positions.push_back(end.cast<float>());
}

WallRelief measure(const ScanMap& map) {
    return measure_wall_relief(map, wall(), Vector3d::UnitZ(), 0.0, 2.4, 0.01, 0.1);
}

TEST(WallRelief, TellsWhereRaysEnded) {
    const Vector3d sensor(3.0, 2.0, 1.2);
    ScanMap map;
    add_ray(map, sensor, 0.55, 0.55, 0.0);   // on the wall
    add_ray(map, sensor, 1.55, 0.55, -0.2);  // in a hole
    add_ray(map, sensor, 2.55, 0.55, -3.0);  // through it
    add_ray(map, sensor, 3.55, 0.55, 1.0);   // before it
    add_ray(map, sensor, 0.55, 1.55, 0.03);  // on a casing
    add_ray(map, sensor, 0.55, 9.0, 0.0);    // above the wall
    map.cloud.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 1.0F, 1.0F);
    map.sections.push_back({"scan", 0, static_cast<std::uint32_t>(map.cloud.size()), sensor});
    const WallRelief relief = measure(map);
    EXPECT_TRUE(relief.has_rays);
    EXPECT_EQ(relief.num_columns, 40);
    EXPECT_EQ(relief.num_rows, 24);
    EXPECT_EQ(relief.at(5, 5).surface, 1U);
    EXPECT_EQ(relief.at(15, 5).recess, 1U);
    EXPECT_EQ(relief.at(25, 5).through, 1U);
    EXPECT_EQ(relief.at(35, 5).hidden, 1U);
    EXPECT_NEAR(*hidden_share(relief), 1.0 / (40 * 24), 1e-12);  // the casing hides nothing
    std::uint32_t total = 0;
    for (const ReliefCell& cell : relief.cells)
        total += cell.surface + cell.open() + cell.hidden;
    EXPECT_EQ(total, 5U);
    // 0.2 m deep.
    const std::size_t bin = static_cast<std::size_t>(0.2 / depth_bin);
    EXPECT_EQ(relief.depths[relief.index(15, 5) * num_depth_bins + bin], 1U);
}

/// A shelf's things are before what a scanner looks at straight, not where its rays aimed at.
TEST(WallRelief, TellsWhatStandsStraightBeforeIt) {
    const Vector3d sensor(3.0, 0.5, 1.2);
    ScanMap map;
    add_ray(map, sensor, 2.5, 1.2, 0.6);  // ends before 2.1
    add_ray(map, sensor, 2.5, 1.2, 1.5);  // farther than furniture is deep
    map.sections.push_back({"scan", 0, 2, sensor});
    const WallRelief relief = measure(map);
    EXPECT_EQ(relief.at(25, 12).hidden + relief.at(24, 12).hidden, 2U);
    std::uint32_t num_standing = 0;
    for (const ReliefCell& cell : relief.cells)
        num_standing += cell.standing;
    EXPECT_EQ(num_standing, 1U);
    EXPECT_EQ(relief.at(21, 12).standing + relief.at(20, 12).standing, 1U);
}

TEST(WallRelief, HearsNoScannerBehindTheWall) {
    ScanMap map;
    add_ray(map, Vector3d(3.0, 2.0, 1.2), 0.55, 0.55, -3.0);
    map.sections.push_back({"scan", 0, 1, Vector3d(-2.0, 2.0, 1.2)});
    const WallRelief relief = measure(map);
    for (const ReliefCell& cell : relief.cells)
        EXPECT_EQ(cell.surface + cell.open() + cell.hidden, 0U);
}

TEST(WallRelief, PlacesPointsOfUnknownScanners) {
    ScanMap map;
    map.cloud.positions.emplace_back(0.0F, 0.55F, 0.55F);
    map.cloud.positions.emplace_back(-0.2F, 1.55F, 0.55F);
    map.cloud.positions.emplace_back(-2.0F, 2.55F, 0.55F);
    map.sections.push_back({"map", 0, 3, std::nullopt});
    const WallRelief relief = measure(map);
    EXPECT_FALSE(relief.has_rays);
    EXPECT_FALSE(hidden_share(relief));
    EXPECT_EQ(relief.at(5, 5).surface, 1U);
    EXPECT_EQ(relief.at(15, 5).recess, 1U);
}

TEST(WallRelief, GuessesAHoleWhereNothingWasSeenAndNothingStands) {
    ScanMap map;
    map.cloud.positions.emplace_back(0.0F, 0.55F, 0.55F);   // on the wall
    map.cloud.positions.emplace_back(-2.0F, 2.55F, 0.55F);  // far behind it
    map.cloud.positions.emplace_back(0.6F, 3.55F, 0.55F);   // before it
    map.sections.push_back({"map", 0, 3, std::nullopt});
    const WallRelief relief = measure(map);
    EXPECT_EQ(relief.at(5, 5).open(), 0U);
    EXPECT_GT(relief.at(25, 5).through, 0U);
    EXPECT_EQ(relief.at(35, 5).open(), 0U);
    EXPECT_EQ(relief.at(35, 5).hidden, 1U);
}

/// Points on the wall and in it count where they lie, once for all views; what the views look over
/// or through counts where they look.
TEST(WallRelief, FollowsInferredViewsBeyondTheWall) {
    const Vector3d eye(3.0, 2.0, 1.2);
    ScanMap map;
    add_ray(map, eye, 0.55, 0.55, 0.0);   // on the wall
    add_ray(map, eye, 1.55, 0.55, -0.2);  // in a hole
    add_ray(map, eye, 3.55, 0.55, 1.0);   // before it
    for (const double x : {-1.0, -2.0, -3.0})
        add_ray(map, eye, 2.55, 0.55, x);  // through it
    map.sections.push_back({"map", 0, 6, std::nullopt});
    map.inferred_views = {
        {eye, {0, 1, 2, 3, 4, 5}}, {eye, {0, 1}}, {Vector3d(-2.0, 2.0, 1.2), {4, 5}}};
    const WallRelief relief = measure(map);
    EXPECT_FALSE(relief.has_rays);
    EXPECT_TRUE(relief.looks_beyond);
    EXPECT_EQ(relief.at(5, 5).surface, 1U);
    std::uint32_t num_recess = 0;
    for (const ReliefCell& cell : relief.cells)
        num_recess += cell.recess;
    EXPECT_EQ(num_recess, 1U);
    EXPECT_EQ(relief.at(25, 5).through, 3U);
    EXPECT_EQ(relief.at(35, 5).hidden, 1U);
    // Nobody looked here: a guess, as without views.
    EXPECT_GT(relief.at(20, 20).through, 0U);
}

TEST(WallRelief, IsCutByColumns) {
    const Vector3d sensor(3.0, 2.0, 1.2);
    ScanMap map;
    add_ray(map, sensor, 1.55, 0.55, -0.2);
    add_ray(map, sensor, 2.55, 0.55, 0.0);
    map.sections.push_back({"scan", 0, 2, sensor});
    const WallRelief relief = measure(map);
    const WallRelief part = columns_of(relief, 15, 11);
    EXPECT_EQ(part.num_columns, 11);
    EXPECT_EQ(part.num_rows, relief.num_rows);
    EXPECT_NEAR(part.start, 1.5, 1e-12);
    EXPECT_EQ(part.at(0, 5).recess, 1U);
    EXPECT_EQ(part.at(10, 5).surface, 1U);
    const std::size_t bin = static_cast<std::size_t>(0.2 / depth_bin);
    EXPECT_EQ(part.depths[part.index(0, 5) * num_depth_bins + bin], 1U);
}

/// A hole of 0.9 x 2 m in a wall of an unknown scanner's map, with a lining 0.1 m deep or without.
WallRelief doorway(bool is_lined) {
    ScanMap map;
    for (float y = 0.01F; y < 4.0F; y += 0.02F) {
        for (float z = 0.01F; z < 2.4F; z += 0.02F) {
            const bool is_hole = y > 1.5F && y < 2.4F && z < 2.0F;
            if (!is_hole) map.cloud.positions.emplace_back(0.0F, y, z);
        }
    }
    for (float x = -0.09F; is_lined && x < 0.0F; x += 0.02F) {
        for (float z = 0.01F; z < 2.0F; z += 0.02F) {
            map.cloud.positions.emplace_back(x, 1.5F, z);
            map.cloud.positions.emplace_back(x, 2.4F, z);
        }
        for (float y = 1.51F; y < 2.4F; y += 0.02F)
            map.cloud.positions.emplace_back(x, y, 2.0F);
    }
    map.sections.push_back({"map", 0, static_cast<std::uint32_t>(map.cloud.size()), std::nullopt});
    return measure(map);
}

TEST(WallHoles, AreLinedWhereTheWallGoesInwards) {
    for (const bool is_lined : {true, false}) {
        const WallRelief relief = doorway(is_lined);
        const std::vector<CellRectangle> holes = find_wall_holes(relief);
        ASSERT_EQ(holes.size(), 1U);
        EXPECT_NEAR(relief.cell_size * (holes[0].right - holes[0].left), 0.9, 0.15);
        const HoleEvidence evidence = look_into(relief, holes[0]);
        EXPECT_GT(evidence.through_share, 0.8);
        if (is_lined) {
            EXPECT_GT(evidence.lining, 0.9);
        } else {
            EXPECT_EQ(evidence.lining, 0.0);
        }
    }
}

/// A hole of 1 x 1.4 m, 1 m above the floor; `depth`: m, of what is seen at x, z in it. Where it is
/// 0, nothing was seen; where it is negative, wall.
WallRelief hole_with(const std::function<double(double, double)>& depth) {
    WallRelief relief = measure({});
    relief.has_rays = true;
    for (int row = 0; row < relief.num_rows; ++row) {
        for (int column = 0; column < relief.num_columns; ++column) {
            ReliefCell& cell = relief.cells[relief.index(column, row)];
            const bool is_hole = column >= 15 && column < 25 && row >= 6 && row < 20;
            const double at = is_hole ? depth(0.1 * (column - 14.5), 0.1 * (row - 5.5)) : -1.0;
            cell.surface = at < 0.0 ? 4 : 0;
            cell.through = 0;
            cell.recess = at > 0.0 ? 4 : 0;
            const auto bin = static_cast<std::size_t>(std::max(at, 0.0) / depth_bin);
            relief.depths[relief.index(column, row) * num_depth_bins + bin] =
                static_cast<std::uint16_t>(cell.recess);
        }
    }
    return relief;
}

TEST(WallHoles, AreOneWhereSomethingStandsBeforeThem) {
    const auto with_band = [](double value) {
        return [value](double, double z) { return z > 0.5 && z < 0.9 ? value : 0.1; };
    };
    const std::vector<CellRectangle> holes = find_wall_holes(hole_with(with_band(0.0)));
    ASSERT_EQ(holes.size(), 1U);
    EXPECT_EQ(holes[0].low, 6);
    EXPECT_EQ(holes[0].high, 20);
    EXPECT_EQ(find_wall_holes(hole_with(with_band(-1.0))).size(), 2U);  // wall between them
}

TEST(WallHoles, AreFlushPanesWithoutAFrameInThem) {
    const auto pane_with = [](double frame) {
        WallRelief relief = hole_with([=](double x, double z) {
            const bool is_rim = x < 0.2 || x > 0.8 || z < 0.2 || z > 1.2;
            return is_rim ? frame : 0.0;
        });
        for (int row = 6; row < 20; ++row) {
            for (int column = 15; column < 25; ++column) {
                ReliefCell& cell = relief.cells[relief.index(column, row)];
                if (cell.recess == 0) cell.through = 4;
            }
        }
        const std::vector<CellRectangle> holes = find_wall_holes(relief);
        EXPECT_EQ(holes.size(), 1U);
        return look_into(relief, holes.at(0));
    };
    EXPECT_TRUE(is_flush_pane(pane_with(0.0)));
    EXPECT_FALSE(is_flush_pane(pane_with(0.1)));
}

TEST(WallHoles, TellAFrameFromTheSidesOfANiche) {
    const WallRelief window = hole_with(
        [](double x, double z) { return x > 0.2 && x < 0.8 && z > 0.2 && z < 1.2 ? 0.15 : 0.1; });
    const WallRelief niche = hole_with([](double x, double z) {
        return x > 0.2 && x < 0.8 && z > 0.2 && z < 1.2 ? 0.3 : 0.02 + 0.07 * (x + z);
    });
    for (const WallRelief* relief : {&window, &niche}) {
        const std::vector<CellRectangle> holes = find_wall_holes(*relief);
        ASSERT_EQ(holes.size(), 1U);
        const HoleEvidence evidence = look_into(*relief, holes[0]);
        EXPECT_GT(evidence.sunk(), 0.02);
        if (relief == &window) {
            EXPECT_EQ(evidence.depths.rim_at_depth, 1.0);
        } else {
            EXPECT_LT(evidence.depths.rim_at_depth, 0.6);
        }
    }
}

/// A frame returns every ray, a pane few; what fills a niche, all.
TEST(WallHoles, TellPanesByTheFewRaysTheyReturn) {
    for (const bool is_pane : {true, false}) {
        WallRelief relief = hole_with([](double, double) { return 0.1; });
        for (int row = 8; row < 18; ++row) {
            for (int column = 17; column < 23; ++column)
                relief.cells[relief.index(column, row)].recess = is_pane ? 1 : 4;
        }
        const std::vector<CellRectangle> holes = find_wall_holes(relief);
        ASSERT_EQ(holes.size(), 1U);
        EXPECT_EQ(look_into(relief, holes[0]).thinned, is_pane ? 0.25 : 1.0);
    }
}

TEST(WallHoles, HaveTheirFrameBehindADeepReveal) {
    const auto frame_behind = [](double reveal) {
        const WallRelief relief = hole_with([=](double x, double z) {
            if (x < 0.1 || x > 0.9 || z < 0.1 || z > 1.3) return 0.0;
            return x > 0.2 && x < 0.8 && z > 0.2 && z < 1.2 ? 0.25 : reveal;
        });
        return look_into(relief, {15, 25, 6, 20}).frame_depth();
    };
    EXPECT_NEAR(frame_behind(0.05), 0.25, depth_bin);
    EXPECT_NEAR(frame_behind(0.21), 0.21, depth_bin);  // a pane in its frame
}

TEST(WallHoles, EndWhereABlindBeforeTheWallDoes) {
    WallRelief relief = hole_with([](double, double) { return 0.1; });
    const CellRectangle hole = find_wall_holes(relief).at(0);
    ASSERT_EQ(hole.high, 20);
    EXPECT_EQ(top_of_blind(relief, hole), 20);
    const auto hang = [&](int first, int last) {
        for (int row = 20; row < 23; ++row) {
            for (int column = first; column < last; ++column) {
                ReliefCell& cell = relief.cells[relief.index(column, row)];
                cell.near = 4;
                cell.height = 4.0F * 0.05F;
            }
        }
    };
    hang(15, 25);
    EXPECT_EQ(top_of_blind(relief, hole), 23);
    hang(0, 40);  // a beam along the whole wall
    EXPECT_EQ(top_of_blind(relief, hole), 20);
}

}  // namespace
}  // namespace roomscribe
