// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/settings.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/line_segment.hpp"
#include "roomscribe/geometry/quadrilateral.hpp"

namespace roomscribe {

/// Three or four segments that make a rectangular shape.
struct AssembledQuadrilateral {
    Quadrilateral quadrilateral;
    std::vector<std::uint32_t> lines;  ///< numbers of the segments, in the order they were added
};

struct QuadrilateralSettings {
    double end_distance = 0.15;
    double angle_tolerance = radians(5.0);

    void visit(SettingVisitor& visitor) {
        visitor(end_distance, {.name = "end_distance",
                               .unit = "m",
                               .min = 0.0,
                               .max = 1e6,
                               .doc = "Ends of segments are near each other up to this distance: "
                                      "condition (a)."});
        visitor(angle_tolerance,
                {.name = "angle_tolerance",
                 .unit = "rad",
                 .min = 0.0,
                 .max = 0.7,
                 .doc = "Segments meet at a right angle up to this: condition (b), "
                        "the paper's 90 +- 5 degrees."});
    }
};

/// The paper's Algorithm 4, step by step: starting with the first segment that is left, segments
/// are added to a shape whose ends they are near to (a) and at a right angle to the segment there
/// (b), up to four; shapes of more than two are kept. What (a) and (b)
/// as printed let through, though it is no rectangle, a staircase or a step in space, is refused:
/// the shape turns the same way at each corner. Corners are where neighbouring segments come
/// nearest to each other; of three segments the longer arm says where the fourth side is, since
/// what hides an arm makes it shorter. Every segment serves once at most, whether or not its shape
/// was kept.
std::vector<AssembledQuadrilateral> assemble_quadrilaterals(
    std::span<const LineSegment> lines, const QuadrilateralSettings& settings = {});

}  // namespace roomscribe
