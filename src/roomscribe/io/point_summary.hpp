// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace roomscribe {

/// What is said of the positions of a scan without keeping them. It takes the same memory for any
/// number of points.
struct PointSummary {
    std::size_t num_points = 0;
    std::size_t num_finite = 0;
    Eigen::AlignedBox3f bounds;           ///< of the finite points; empty if none is
    std::vector<Eigen::Vector3f> sample;  ///< an even one, of which median_distance takes all
};

/// Of the points from number `first` on, in a scan of `num_points`.
PointSummary summarize_points(std::span<const Eigen::Vector3f> positions, std::size_t first,
                              std::size_t num_points);

/// Of points and those that follow them.
PointSummary joined(PointSummary summary, const PointSummary& next);

}  // namespace roomscribe
