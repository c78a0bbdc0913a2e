// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_summary.hpp"

#include <algorithm>

namespace roomscribe {
namespace {

constexpr std::size_t min_samples = 10000;

}  // namespace

PointSummary summarize_points(std::span<const Eigen::Vector3f> positions, std::size_t first,
                              std::size_t num_points) {
    PointSummary summary;
    summary.num_points = positions.size();
    for (const Eigen::Vector3f& position : positions) {
        if (!position.allFinite()) continue;
        ++summary.num_finite;
        summary.bounds.extend(position);
    }
    const std::size_t step = std::max<std::size_t>(1, num_points / min_samples);
    for (std::size_t i = (first + step - 1) / step * step; i < first + positions.size(); i += step)
        summary.sample.push_back(positions[i - first]);
    return summary;
}

PointSummary joined(PointSummary summary, const PointSummary& next) {
    summary.num_points += next.num_points;
    summary.num_finite += next.num_finite;
    summary.bounds.extend(next.bounds);
    summary.sample.insert(summary.sample.end(), next.sample.begin(), next.sample.end());
    return summary;
}

}  // namespace roomscribe
