// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/stray_returns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {
namespace {

/// On however steep a plane, the rays to the left and to the right meet it beside this one, and a
/// third nearby.
constexpr std::size_t num_beside = 3;
/// How far off these are, in spacings of rays: a lost return leaves a gap.
constexpr double max_gap = 2.0;

/// m: returns farther apart show no surface of a room, and far out strays are as dense as rays.
constexpr double max_distance = 0.3;

double range_of(const Eigen::Vector3f& point, const Eigen::Vector3d& sensor) {
    return (point.cast<double>() - sensor).norm();
}

/// Of each point, how far off the last of those beside it is, as a share of its range.
/// A point that is in the tree finds itself first.
std::vector<double> measure_gaps(std::span<const Eigen::Vector3f> points, const SearchTree& tree,
                                 const Eigen::Vector3d& sensor, const Context& context) {
    std::vector<double> gaps(points.size());
    parallel_for(context, points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<Neighbor> neighbors;
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_finite(points[i])) continue;
            tree.nearest(points[i], num_beside + 1, neighbors);
            const double range = range_of(points[i], sensor);
            const auto squared_distance = static_cast<double>(neighbors.back().squared_distance);
            gaps[i] = range > 0.0 ? std::sqrt(squared_distance) / range : 0.0;
        }
    });
    return gaps;
}

/// How far apart returns lie: half of them are nearer to those beside them.
struct Spacing {
    double angle = 0.0;     ///< of rays, rad
    double distance = 0.0;  ///< m

    /// Farther off than so many spacings. By both measures: in a cloud of several scans the rays do
    /// not begin at one place, and those that are near it only seem far apart.
    bool is_exceeded(double gap, double range, double factor) const {
        return gap > factor * angle && gap * range > factor * distance;
    }
};

Spacing measure_spacing(const std::vector<Eigen::Vector3f>& points, std::vector<double> gaps,
                        const Eigen::Vector3d& sensor) {
    std::vector<double> distances(gaps.size());
    for (std::size_t i = 0; i < gaps.size(); ++i)
        distances[i] = gaps[i] * range_of(points[i], sensor);
    return {median(gaps), median(distances)};
}

bool is_stray(double gap, double range, double factor, const Spacing& spacing) {
    return spacing.is_exceeded(gap, range, factor) || gap * range > max_distance;
}

/// Some returns that lie on surfaces.
struct SurfaceSample {
    std::vector<Eigen::Vector3f> points;
    Spacing spacing;
};

/// Leaves the strays out; empty if they are so few that they do no harm.
SurfaceSample without_strays(std::vector<Eigen::Vector3f> points, const Eigen::Vector3d& sensor,
                             const Context& context) {
    // Of scans by all scanners, real and simulated, that have none, at most 0.5 per cent lie so far
    // off: what is seen through leaves, and rims.
    constexpr double lonely = 5.0;
    constexpr double min_share = 0.01;
    // Strays among strays pass until the others are gone.
    constexpr int num_passes = 5;
    SurfaceSample sample;
    for (int pass = 0; pass < num_passes && points.size() > num_beside; ++pass) {
        const std::vector<double> gaps = measure_gaps(points, SearchTree(points), sensor, context);
        sample.spacing = measure_spacing(points, gaps, sensor);
        std::size_t num_lonely = 0;
        std::vector<Eigen::Vector3f> kept;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double range = range_of(points[i], sensor);
            if (sample.spacing.is_exceeded(gaps[i], range, lonely)) ++num_lonely;
            if (!is_stray(gaps[i], range, max_gap, sample.spacing)) kept.push_back(points[i]);
        }
        if (pass == 0 &&
            static_cast<double>(num_lonely) < min_share * static_cast<double>(points.size())) {
            return {};
        }
        points = std::move(kept);
    }
    sample.points = std::move(points);
    return sample;
}

}  // namespace

std::vector<std::uint32_t> find_stray_returns(std::span<const Eigen::Vector3f> positions,
                                              const Eigen::Vector3d& sensor,
                                              const Context& context) {
    // Enough to find surfaces by.
    constexpr double max_sample = 100'000.0;
    // Every n-th return of a grid would thin its rows or its columns alone.
    Random random(1);
    const double share = max_sample / static_cast<double>(positions.size());
    std::vector<Eigen::Vector3f> drawn;
    for (const Eigen::Vector3f& position : positions) {
        if (random.uniform() < share && is_finite(position)) drawn.push_back(position);
    }
    const SurfaceSample sample = without_strays(std::move(drawn), sensor, context);
    if (sample.points.size() <= num_beside) return {};
    const SearchTree tree(sample.points);
    // Where rays graze a surface the sample has gaps, and its strays are gone.
    constexpr double reach = 2.0 * max_gap;
    const std::vector<double> gaps = measure_gaps(positions, tree, sensor, context);
    std::vector<std::uint32_t> strays;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (is_finite(positions[i]) &&
            is_stray(gaps[i], range_of(positions[i], sensor), reach, sample.spacing)) {
            strays.push_back(i);
        }
    }
    return strays;
}

}  // namespace roomscribe
