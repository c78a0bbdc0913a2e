// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/quadrilateral.hpp"
#include "roomscribe/structure/outline_lines.hpp"

namespace roomscribe {

/// A rectangle of which at least three sides were seen, in the plane's coordinates.
struct OutlineRectangle {
    /// Counter-clockwise.
    std::array<Eigen::Vector2d, 4> corners{};
    bool is_hole = false;  ///< the material lies around it: a window's hole, a doorway
    int num_sides = 0;     ///< that lines confirm: 3 or 4
    double support = 0.0;  ///< share of the perimeter along which lines run, in [0, 1]
};

struct OutlineRectangleSettings {
    double angle_tolerance = radians(5.0);  ///< the paper's 90 +- 5 degrees
    double distance_tolerance = 0.02;       ///< m, of lines that are one side
    double min_side = 0.15;                 ///< m
};

/// Rectangles among the outline's lines, by falling support. Beyond the paper's Algorithm 4 it
/// needs no ends that meet: sides may be broken by what stands before them, corners be hidden, and
/// a side be shared out over several lines. What counts is how much of three or four sides is
/// confirmed by lines that have their material on the right side: inside for an island, outside for
/// a hole. A notch in the rim, as a doorway is, counts as a hole without its fourth side. No line
/// serves two rectangles of the same kind.
std::vector<OutlineRectangle> find_outline_rectangles(
    std::span<const OutlineLine> lines, const OutlineRectangleSettings& settings = {});

/// The rectangle where it lies in the cloud's frame.
Quadrilateral place_on_plane(const OutlineRectangle& rectangle, const Plane& plane);

}  // namespace roomscribe
