// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/structure/boundary_points.hpp"
#include "roomscribe/structure/line_segments.hpp"
#include "roomscribe/structure/quadrilaterals.hpp"
#include "support/contexts.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

struct Grid {
    std::vector<Eigen::Vector3f> positions;
    std::vector<std::uint32_t> points;
    std::set<std::uint32_t> rim;

    /// n x n points a centimetre apart; the middle k x k left out.
    Grid(int n, int k) {
        const int low = (n - k) / 2;
        const int high = low + k;
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const auto is_in_hole = [&](int a, int b) {
                    return a >= low && a < high && b >= low && b < high;
                };
                if (is_in_hole(x, y)) continue;
                const bool is_outer = x == 0 || y == 0 || x == n - 1 || y == n - 1;
                const bool is_inner = is_in_hole(x + 1, y) || is_in_hole(x - 1, y) ||
                                      is_in_hole(x, y + 1) || is_in_hole(x, y - 1);
                if (is_outer || is_inner) rim.insert(static_cast<std::uint32_t>(positions.size()));
                positions.emplace_back(0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y),
                                       1.0F);
            }
        }
        points.resize(positions.size());
        std::iota(points.begin(), points.end(), 0U);
    }
};

const Plane level{Vector3d::UnitZ(), 1.0};

TEST(FindBoundaryPoints, AreTheRimsOfASquareAndItsHole) {
    const Grid grid(40, 12);
    // At the corners of the hole exactly a right angle is free: to be told from a rim.
    const auto found = find_boundary_points(grid.positions, grid.points, level,
                                            {.radius = 0.025, .max_angle = radians(100.0)});
    EXPECT_EQ(std::set<std::uint32_t>(found.begin(), found.end()), grid.rim);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
}

/// Sorting all angles, as the definition has it.
bool is_boundary(const Grid& grid, std::uint32_t point, double radius, double max_angle) {
    std::vector<double> angles;
    for (const std::uint32_t other : grid.points) {
        const Eigen::Vector3f offset = grid.positions[other] - grid.positions[point];
        if (offset.norm() == 0.0F || static_cast<double>(offset.norm()) > radius) continue;
        angles.push_back(
            std::atan2(static_cast<double>(offset.y()), static_cast<double>(offset.x())));
    }
    if (angles.size() < 2) return false;
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i)
        gap = std::max(gap, angles[i] - angles[i - 1]);
    return gap > max_angle;
}

TEST(FindBoundaryPoints, AgreeWithTheDefinitionOnScatteredPoints) {
    Grid grid(20, 0);
    Random random(4);
    for (Eigen::Vector3f& position : grid.positions) {
        position.x() += static_cast<float>(0.004 * random.normal());
        position.y() += static_cast<float>(0.004 * random.normal());
    }
    grid.positions[30] = grid.positions[31];
    for (const double max_angle : {1.2, 0.5 * std::numbers::pi, 2.4}) {
        SCOPED_TRACE(max_angle);
        for (const int threads : {1, 3}) {
            const auto found = find_boundary_points(grid.positions, grid.points, level,
                                                    {.radius = 0.03, .max_angle = max_angle},
                                                    test::with_threads(threads));
            const std::set<std::uint32_t> set(found.begin(), found.end());
            for (const std::uint32_t point : grid.points) {
                EXPECT_EQ(set.count(point) == 1, is_boundary(grid, point, 0.03, max_angle))
                    << point;
            }
        }
    }
}

TEST(FindBoundaryPoints, OfNoneOrOneThereAreNone) {
    EXPECT_TRUE(find_boundary_points({}, {}, level).empty());
    const std::vector<Eigen::Vector3f> one{Eigen::Vector3f::Zero()};
    EXPECT_EQ(find_boundary_points(one, std::vector<std::uint32_t>{0}, level).size(), 0U);
    const std::vector<Eigen::Vector3f> nowhere{Eigen::Vector3f::Constant(NAN)};
    EXPECT_THROW(find_boundary_points(nowhere, std::vector<std::uint32_t>{0}, level),
                 InvalidArgument);
    EXPECT_THROW(find_boundary_points(one, std::vector<std::uint32_t>{0}, level, {.radius = 0.0}),
                 InvalidArgument);
}

/// Points along a segment, a centimetre apart, with noise across it.
void add_segment(std::vector<Eigen::Vector3f>& positions, const Vector3d& a, const Vector3d& b,
                 Random& random) {
    const int count = static_cast<int>((b - a).norm() / 0.01);
    for (int i = 0; i <= count; ++i) {
        const Vector3d noise(random.normal(), random.normal(), random.normal());
        positions.emplace_back((a + (b - a) * i / count + 0.002 * noise).cast<float>());
    }
}

TEST(FitLineSegments, FindsTheFourSidesOfARectangle) {
    Random random(8);
    std::vector<Eigen::Vector3f> positions;
    const Vector3d corners[] = {{0, 0, 0}, {2, 0, 0}, {2, 0, 0.8}, {0, 0, 0.8}};
    for (int i = 0; i < 4; ++i)
        add_segment(positions, corners[i], corners[(i + 1) % 4], random);
    std::vector<std::uint32_t> all(positions.size());
    std::iota(all.begin(), all.end(), 0U);
    const LineSegmentsResult result =
        fit_line_segments(positions, all, 1, {.distance_tolerance = 0.01, .consensus = {}});
    ASSERT_EQ(result.lines.size(), 4U);
    EXPECT_NEAR(result.lines[0].segment.length(), 2.0, 0.02);
    EXPECT_NEAR(result.lines[3].segment.length(), 0.8, 0.05);
    std::size_t num_points = result.remaining_points.size();
    for (const BoundaryLine& line : result.lines) {
        EXPECT_LT(line.rms, 0.006);
        num_points += line.points.size();
    }
    EXPECT_EQ(num_points, positions.size());
    EXPECT_EQ(result.stop, LineSegmentsStop::few_points_left);
}

TEST(FitLineSegments, KeepsTheLargestClusterAndComesBackForTheOthers) {
    Random random(8);
    std::vector<Eigen::Vector3f> positions;
    add_segment(positions, {0, 0, 0}, {1.0, 0, 0}, random);
    add_segment(positions, {1.5, 0, 0}, {2.0, 0, 0}, random);
    add_segment(positions, {2.5, 0, 0}, {2.6, 0, 0}, random);
    std::vector<std::uint32_t> all(positions.size());
    std::iota(all.begin(), all.end(), 0U);
    const LineSegmentsResult result =
        fit_line_segments(positions, all, 1, {.distance_tolerance = 0.01, .consensus = {}});
    ASSERT_EQ(result.lines.size(), 2U);
    EXPECT_NEAR(result.lines[0].segment.length(), 1.0, 0.01);
    EXPECT_NEAR(result.lines[1].segment.length(), 0.5, 0.01);
    EXPECT_EQ(result.remaining_points.size(), 11U);
}

TEST(FitLineSegments, StopsWhereNoClusterIsLargeEnough) {
    Random random(2);
    std::vector<Eigen::Vector3f> positions;
    for (int i = 0; i < 60; ++i) {
        positions.emplace_back(static_cast<float>(random.uniform(0, 10)),
                               static_cast<float>(random.uniform(0, 10)), 0.0F);
    }
    std::vector<std::uint32_t> all(positions.size());
    std::iota(all.begin(), all.end(), 0U);
    const LineSegmentsResult result =
        fit_line_segments(positions, all, 1, {.distance_tolerance = 0.01, .consensus = {}});
    EXPECT_TRUE(result.lines.empty());
    EXPECT_EQ(result.stop, LineSegmentsStop::small_cluster);
    EXPECT_EQ(result.remaining_points.size(), 60U);
    EXPECT_TRUE(fit_line_segments(positions, {}, 1).lines.empty());
}

std::vector<LineSegment> door(double gap) {
    // Not in order around, two of them turned.
    return {{{gap, 0, 0}, {0.9 - gap, 0, 0}},
            {{0.9 - gap, 0, 2.0}, {gap, 0, 2.0}},
            {{0, 0, 2.0 - gap}, {0, 0, gap}},
            {{0.9, 0, 2.0 - gap}, {0.9, 0, gap}}};
}

double corner_error(const Quadrilateral& quad) {
    double worst = 0.0;
    for (const Vector3d& corner :
         {Vector3d(0, 0, 0), Vector3d(0.9, 0, 0), Vector3d(0.9, 0, 2), Vector3d(0, 0, 2)}) {
        double nearest = 1e9;
        for (const Vector3d& found : quad.corners)
            nearest = std::min(nearest, (found - corner).norm());
        worst = std::max(worst, nearest);
    }
    return worst;
}

TEST(AssembleQuadrilaterals, FindsADoorOfFourSegmentsWhoseEndsDoNotMeet) {
    const auto quads = assemble_quadrilaterals(door(0.05));
    ASSERT_EQ(quads.size(), 1U);
    EXPECT_EQ(quads[0].lines.size(), 4U);
    EXPECT_LT(corner_error(quads[0].quadrilateral), 1e-9);
}

TEST(AssembleQuadrilaterals, CompletesThreeSegmentsByTheLongerArm) {
    std::vector<LineSegment> lines = door(0.0);
    lines.erase(lines.begin());
    lines[1].end.z() = 0.4;  // one arm is partly hidden
    const auto quads = assemble_quadrilaterals(lines);
    ASSERT_EQ(quads.size(), 1U);
    EXPECT_EQ(quads[0].lines.size(), 3U);
    EXPECT_LT(corner_error(quads[0].quadrilateral), 1e-9);
}

TEST(AssembleQuadrilaterals, RejectsAnLASlantAndDistantEnds) {
    const std::vector<LineSegment> two{door(0.0)[0], door(0.0)[2]};
    EXPECT_TRUE(assemble_quadrilaterals(two).empty());
    std::vector<LineSegment> slanted = door(0.0);
    slanted[2].start.x() += 0.5;
    slanted[3].start.x() += 0.5;
    EXPECT_TRUE(assemble_quadrilaterals(slanted).empty());
    EXPECT_TRUE(assemble_quadrilaterals(door(0.2)).empty());
    EXPECT_TRUE(assemble_quadrilaterals({}).empty());
    EXPECT_THROW(assemble_quadrilaterals(two, {.end_distance = -1.0}), InvalidArgument);
}

TEST(AssembleQuadrilaterals, RejectsAStaircaseAndAStepInSpace) {
    const std::vector<LineSegment> staircase{{{0, 0, 0}, {1, 0, 0}},
                                             {{1, 0, 0}, {1, 0, 1}},
                                             {{1, 0, 1}, {2, 0, 1}},
                                             {{2, 0, 1}, {2, 0, 2}}};
    EXPECT_TRUE(assemble_quadrilaterals(staircase).empty());
    const std::vector<LineSegment> step{
        {{0, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {1, 1, 0}}, {{1, 1, 0}, {1, 1, 1}}};
    EXPECT_TRUE(assemble_quadrilaterals(step).empty());
}

TEST(AssembleQuadrilaterals, TellsTwoDoorsApart) {
    std::vector<LineSegment> lines = door(0.0);
    for (LineSegment line : door(0.0)) {
        line.start.x() += 3.0;
        line.end.x() += 3.0;
        lines.push_back(line);
    }
    EXPECT_EQ(assemble_quadrilaterals(lines).size(), 2U);
}

}  // namespace
}  // namespace roomscribe
