// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

/// What every radius and tolerance follows from.
struct ScanStatistics {
    std::size_t num_points = 0;  ///< finite ones
    /// m, the median over the surface (not over the points: each occupied voxel counts once) of the
    /// distance between neighbouring points.
    double point_spacing = 0.0;
    /// m, standard deviation of the points about smooth surface: a low quantile of the residuals of
    /// local planes no larger than 0.6 m, so that edges and clutter do not count.
    double noise = 0.0;
    /// m, diagonal of the box that holds the middle 98 % of the points along each axis.
    double extent = 0.0;
};

/// Estimates from a deterministic sample of the points. All zero if fewer than 3 points are finite
/// or all are equal.
ScanStatistics estimate_scan_statistics(const PointCloud& cloud, const Context& context = {});

}  // namespace roomscribe
