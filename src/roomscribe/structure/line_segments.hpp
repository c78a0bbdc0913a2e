// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/line_segment.hpp"
#include "roomscribe/geometry/sample_consensus.hpp"

namespace roomscribe {

/// A straight run of boundary points.
struct BoundaryLine {
    LineSegment segment;                ///< from the first to the last of the points
    std::vector<std::uint32_t> points;  ///< ascending
    double rms = 0.0;                   ///< m, of the points about the line
};

struct LineSegmentsSettings {
    double distance_tolerance = 0.03;
    double cluster_gap = 0.15;
    int min_inliers = 25;
    ConsensusSettings consensus;

    void visit(SettingVisitor& visitor) {
        visitor(distance_tolerance, {.name = "distance_tolerance",
                                     .unit = "m",
                                     .min = 1e-9,
                                     .max = 1e6,
                                     .doc = "An inlier lies no further from the line."});
        visitor(cluster_gap, {.name = "cluster_gap",
                              .unit = "m",
                              .min = 1e-9,
                              .max = 1e6,
                              .doc = "Inliers further apart along the line are two clusters."});
        visitor(min_inliers, {.name = "min_inliers",
                              .unit = "",
                              .min = 2,
                              .max = 1e9,
                              .doc = "Fewest points of a line (the paper's 25)."});
        visitor.group("consensus", consensus);
    }
};

enum class LineSegmentsStop : std::uint8_t {
    few_points_left,  ///< points left < min_inliers
    small_cluster     ///< largest clusters of ten lines in a row < min_inliers
};

struct LineSegmentsResult {
    std::vector<BoundaryLine> lines;  ///< in the order found
    std::vector<std::uint32_t> remaining_points;
    LineSegmentsStop stop = LineSegmentsStop::few_points_left;
};

/// Lines of one plane's boundary points, the paper's Algorithm 3, steps 3 to 12: a line by RANSAC,
/// its inliers clustered along it, the largest cluster alone kept and taken out, until fewer than
/// `min_inliers` points are left. Where the largest cluster is too small the pseudo-code draws
/// another line, for ever if need be; ten in a row end it here. `boundary` numbers `positions`,
/// which must be finite there.
LineSegmentsResult fit_line_segments(std::span<const Eigen::Vector3f> positions,
                                     std::span<const std::uint32_t> boundary, std::uint64_t seed,
                                     const LineSegmentsSettings& settings = {},
                                     const Context& context = {});

}  // namespace roomscribe
