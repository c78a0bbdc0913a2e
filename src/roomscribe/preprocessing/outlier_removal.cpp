// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/outlier_removal.hpp"

#include <algorithm>
#include <cmath>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

/// Standard deviation of a normal distribution over its median absolute deviation.
constexpr double deviation_from_mad = 1.4826;

}  // namespace

std::vector<std::uint32_t> remove_outliers(std::span<const Eigen::Vector3f> positions,
                                           const SearchTree& tree, const OutlierSettings& settings,
                                           const Context& context) {
    check_settings(settings);
    std::vector<std::uint32_t> kept;
    if (positions.empty()) return kept;

    // Duplicates are at distance 0; the floor keeps the logarithm finite and them inside.
    constexpr double min_distance = 1e-9;
    std::vector<double> log_distances(positions.size());
    parallel_for(context, positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<Neighbor> neighbors;
        for (std::size_t i = begin; i < end; ++i) {
            tree.nearest(positions[i], static_cast<std::size_t>(settings.num_neighbors) + 1,
                         neighbors);
            double sum = 0.0;
            for (const Neighbor& neighbor : neighbors)
                sum += std::sqrt(neighbor.squared_distance);
            const double count = std::max<double>(1.0, static_cast<double>(neighbors.size()) - 1.0);
            log_distances[i] = std::log(std::max(sum / count, min_distance));
        }
    });

    std::vector<double> deviations = log_distances;
    const double center = median(deviations);
    std::transform(log_distances.begin(), log_distances.end(), deviations.begin(),
                   [center](double value) { return std::abs(value - center); });
    // A cloud thinned to an even spacing has next to no deviation, and the rim of every surface,
    // where neighbours stand on one side only, would count as outlying. Thinned laser scans deviate
    // by more.
    constexpr double min_deviation = 0.15;
    const double deviation = std::max(min_deviation, deviation_from_mad * median(deviations));
    const double limit = center + settings.max_deviations * deviation;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (log_distances[i] <= limit) kept.push_back(i);
    }
    return kept;
}

}  // namespace roomscribe
