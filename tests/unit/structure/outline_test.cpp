// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/structure/outline_lines.hpp"
#include "roomscribe/structure/outline_rectangles.hpp"
#include "roomscribe/structure/patch_outline.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Shape = std::function<bool(double, double)>;

/// A slanted plane somewhere in space.
Plane some_plane() {
    return {Eigen::Vector3d(0.36, 0.48, 0.8), 1.7};
}

/// Points of a shape in [0, width] x [0, height], every `step` with some jitter, turned by `turn`
/// on some_plane.
struct Sheet {
    std::vector<Eigen::Vector3f> positions;
    std::vector<std::uint32_t> points;

    Sheet(double width, double height, double step, double turn, const Shape& contains) {
        Random random(11);
        const Plane plane = some_plane();
        const PlaneAxes axes = plane_axes(plane.normal);
        for (double x = 0.5 * step; x < width; x += step) {
            for (double y = 0.5 * step; y < height; y += step) {
                const double a = x + 0.2 * step * random.normal();
                const double b = y + 0.2 * step * random.normal();
                if (!contains(a, b)) continue;
                const Vector2d at = placed(a, b, turn);
                const Eigen::Vector3d point =
                    at.x() * axes.u + at.y() * axes.v + plane.offset * plane.normal;
                positions.push_back(point.cast<float>());
            }
        }
        points.resize(positions.size());
        std::iota(points.begin(), points.end(), 0U);
    }

    static Vector2d placed(double x, double y, double turn) {
        return {std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y};
    }

    PatchOutline outline() const { return trace_outline(positions, points, some_plane(), 0.01); }

    std::vector<OutlineRectangle> rectangles() const {
        const PatchOutline traced = outline();
        return find_outline_rectangles(find_outline_lines(traced, {.tolerance = traced.cell_size}),
                                       {.distance_tolerance = 1.5 * traced.cell_size});
    }
};

bool is_in(double value, double low, double high) {
    return value > low && value < high;
}

/// Greatest distance of a rectangle's corners from those of [low, high], turned by `turn`.
double corner_error(const OutlineRectangle& rectangle, const Vector2d& low, const Vector2d& high,
                    double turn) {
    double worst = 0.0;
    for (const Vector2d& corner :
         {low, Vector2d(high.x(), low.y()), high, Vector2d(low.x(), high.y())}) {
        double nearest = 1e9;
        for (const Vector2d& found : rectangle.corners) {
            nearest =
                std::min(nearest, (found - Sheet::placed(corner.x(), corner.y(), turn)).norm());
        }
        worst = std::max(worst, nearest);
    }
    return worst;
}

const OutlineRectangle* find_kind(std::span<const OutlineRectangle> rectangles, bool is_hole) {
    const auto found =
        std::find_if(rectangles.begin(), rectangles.end(),
                     [&](const OutlineRectangle& r) { return r.is_hole == is_hole; });
    return found == rectangles.end() ? nullptr : &*found;
}

TEST(TraceOutline, GoesAroundASheetAndItsHole) {
    const Sheet sheet(1.0, 0.8, 0.01, 0.0, [](double x, double y) {
        return !(is_in(x, 0.3, 0.6) && is_in(y, 0.2, 0.5));
    });
    const PatchOutline outline = sheet.outline();
    ASSERT_EQ(outline.loops.size(), 2U);
    const auto is_hole = [](const OutlineLoop& loop) { return loop.is_hole; };
    EXPECT_EQ(std::count_if(outline.loops.begin(), outline.loops.end(), is_hole), 1);
    EXPECT_LE(outline.cell_size, 0.03);
    for (const OutlineLoop& loop : outline.loops) {
        for (const Vector2d& point : loop.points) {
            const double to_rim =
                std::min({point.x(), point.y(), 1.0 - point.x(), 0.8 - point.y()});
            const double to_hole =
                std::max({0.3 - point.x(), point.x() - 0.6, 0.2 - point.y(), point.y() - 0.5});
            EXPECT_LT(loop.is_hole ? to_hole : to_rim, 0.03);
        }
    }
}

TEST(TraceOutline, ClosesTheGapsOfAThinPart) {
    // The right half has one point where the left half has 64.
    const Sheet dense(0.5, 1.0, 0.005, 0.0, [](double, double) { return true; });
    Sheet both(1.0, 1.0, 0.04, 0.0, [](double x, double) { return x > 0.5; });
    both.positions.insert(both.positions.end(), dense.positions.begin(), dense.positions.end());
    both.points.resize(both.positions.size());
    std::iota(both.points.begin(), both.points.end(), 0U);
    const PatchOutline outline = both.outline();
    ASSERT_EQ(outline.loops.size(), 1U);
    EXPECT_FALSE(outline.loops[0].is_hole);
}

TEST(TraceOutline, OfNextToNothingIsEmpty) {
    EXPECT_TRUE(trace_outline({}, {}, Plane{}, 0.01).loops.empty());
    const std::vector<Eigen::Vector3f> one{Eigen::Vector3f::Zero()};
    EXPECT_TRUE(trace_outline(one, std::vector<std::uint32_t>{0}, Plane{}, 0.01).loops.empty());
}

TEST(FindOutlineLines, FindsTheFourSidesOfASheet) {
    for (const double turn : {0.0, 0.3, 1.2}) {
        SCOPED_TRACE(turn);
        const Sheet sheet(1.0, 0.6, 0.01, turn, [](double, double) { return true; });
        const PatchOutline outline = sheet.outline();
        const std::vector<OutlineLine> lines =
            find_outline_lines(outline, {.tolerance = outline.cell_size});
        ASSERT_EQ(lines.size(), 4U);
        double total = 0.0;
        for (const OutlineLine& line : lines) {
            total += line.length();
            EXPECT_LT(line.rms, 0.006);
            // The middle of the sheet lies to the left.
            const Vector2d inwards(-line.direction().y(), line.direction().x());
            EXPECT_GT(inwards.dot(Sheet::placed(0.5, 0.3, turn) - line.start), 0.0);
        }
        EXPECT_NEAR(total, 3.2, 0.15);
    }
}

TEST(FindOutlineRectangles, FindsASheetInAnyTurn) {
    for (const double turn : {0.0, 0.4, 0.785, 1.4, 3.0}) {
        SCOPED_TRACE(turn);
        const Sheet sheet(2.0, 0.8, 0.01, turn, [](double, double) { return true; });
        const auto rectangles = sheet.rectangles();
        ASSERT_EQ(rectangles.size(), 1U);
        EXPECT_EQ(rectangles[0].num_sides, 4);
        EXPECT_FALSE(rectangles[0].is_hole);
        EXPECT_GT(rectangles[0].support, 0.9);
        EXPECT_LT(corner_error(rectangles[0], {0.0, 0.0}, {2.0, 0.8}, turn), 0.02);
    }
}

TEST(FindOutlineRectangles, FindsTheHoleOfAWindow) {
    const Sheet wall(3.0, 2.5, 0.015, 0.2, [](double x, double y) {
        return !(is_in(x, 1.0, 2.2) && is_in(y, 0.9, 2.1));
    });
    const auto rectangles = wall.rectangles();
    const OutlineRectangle* hole = find_kind(rectangles, true);
    ASSERT_NE(hole, nullptr);
    EXPECT_EQ(hole->num_sides, 4);
    EXPECT_LT(corner_error(*hole, {1.0, 0.9}, {2.2, 2.1}, 0.2), 0.025);
    const OutlineRectangle* island = find_kind(rectangles, false);
    ASSERT_NE(island, nullptr);
    EXPECT_LT(corner_error(*island, {0.0, 0.0}, {3.0, 2.5}, 0.2), 0.025);
}

TEST(FindOutlineRectangles, FindsADoorwayThatIsANotch) {
    const Sheet wall(3.0, 2.5, 0.015, 0.7,
                     [](double x, double y) { return !(is_in(x, 1.0, 1.9) && y < 2.0); });
    const OutlineRectangle* hole = nullptr;
    const auto rectangles = wall.rectangles();
    hole = find_kind(rectangles, true);
    ASSERT_NE(hole, nullptr);
    EXPECT_EQ(hole->num_sides, 3);
    EXPECT_LT(corner_error(*hole, {1.0, 0.0}, {1.9, 2.0}, 0.7), 0.03);
}

TEST(FindOutlineRectangles, OutlastsAHiddenCornerAndABrokenSide) {
    const Sheet leaf(0.9, 2.0, 0.01, 0.0, [](double x, double y) {
        const bool is_behind_chair = x < 0.35 && y < 0.5;
        const bool is_behind_handle = x > 0.85 && is_in(y, 0.95, 1.1);
        return !is_behind_chair && !is_behind_handle;
    });
    const auto rectangles = leaf.rectangles();
    ASSERT_FALSE(rectangles.empty());
    EXPECT_LT(corner_error(rectangles[0], {0.0, 0.0}, {0.9, 2.0}, 0.0), 0.02);
}

TEST(FindOutlineRectangles, FindsNoneInATriangleOrAnEllipse) {
    const Sheet triangle(1.0, 1.0, 0.01, 0.1, [](double x, double y) { return y < x; });
    EXPECT_TRUE(triangle.rectangles().empty());
    const Sheet ellipse(1.0, 1.0, 0.01, 0.1,
                        [](double x, double y) { return std::hypot(x - 0.5, y - 0.5) < 0.5; });
    EXPECT_TRUE(ellipse.rectangles().empty());
}

TEST(FindOutlineRectangles, TellsTwoWindowsFromOneWideOne) {
    const Sheet wall(4.0, 2.5, 0.015, 0.0, [](double x, double y) {
        return !((is_in(x, 0.8, 1.7) || is_in(x, 2.0, 2.9)) && is_in(y, 0.9, 2.1));
    });
    std::vector<OutlineRectangle> holes = wall.rectangles();
    std::erase_if(holes, [](const OutlineRectangle& r) { return !r.is_hole; });
    ASSERT_EQ(holes.size(), 2U);
    const Vector2d first_low(0.8, 0.9);
    const Vector2d first_high(1.7, 2.1);
    const Vector2d shift(1.2, 0.0);
    const double straight =
        std::max(corner_error(holes[0], first_low, first_high, 0.0),
                 corner_error(holes[1], first_low + shift, first_high + shift, 0.0));
    const double crossed =
        std::max(corner_error(holes[1], first_low, first_high, 0.0),
                 corner_error(holes[0], first_low + shift, first_high + shift, 0.0));
    EXPECT_LT(std::min(straight, crossed), 0.03);
}

TEST(PlaceOnPlane, PutsTheCornersOnThePlane) {
    const Plane plane = some_plane();
    OutlineRectangle rectangle;
    rectangle.corners = {Vector2d(0.0, 0.0), Vector2d(2.0, 0.0), Vector2d(2.0, 1.0),
                         Vector2d(0.0, 1.0)};
    const Quadrilateral quad = place_on_plane(rectangle, plane);
    for (const Eigen::Vector3d& corner : quad.corners)
        EXPECT_NEAR(plane.signed_distance(corner), 0.0, 1e-12);
    EXPECT_NEAR((quad.corners[2] - quad.corners[0]).norm(), std::sqrt(5.0), 1e-12);
    EXPECT_GT((quad.corners[1] - quad.corners[0])
                  .cross(quad.corners[2] - quad.corners[1])
                  .dot(plane.normal),
              0.0);
}

}  // namespace
}  // namespace roomscribe
