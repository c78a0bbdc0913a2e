// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scan_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"

namespace roomscribe {
namespace {

/// Enough neighbours to leave a single scan line, few enough to stay on one surface.
constexpr std::size_t num_neighbors = 24;

/// The surface is cut into cells, about this many along the diagonal.
constexpr double cells_along_extent = 60.0;

/// At least this share of a scan's surface is smooth (floor, ceiling, walls): the quantile of the
/// residuals that measures noise rather than shape.
constexpr double smooth_quantile = 0.3;

double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0.0;
    const auto rank = std::lround(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

double middle_extent(const std::vector<Eigen::Vector3f>& points) {
    Eigen::Vector3d size;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        std::vector<double> coordinates;
        coordinates.reserve(points.size());
        for (const Eigen::Vector3f& point : points)
            coordinates.push_back(point[axis]);
        const double low = quantile(coordinates, 0.01);
        size[axis] = quantile(coordinates, 0.99) - low;
    }
    return size.norm();
}

/// Places to measure at, spread over the surface, and the points around them.
struct SurfaceSamples {
    std::vector<Eigen::Vector3f> places;
    std::vector<Eigen::Vector3f> points;
};

/// One point per occupied cell of a coarse grid, so that the dense zone near the scanner does not
/// decide. Of a large cloud only the surroundings of some cells are kept: a tree over all points
/// would cost more than everything else.
SurfaceSamples sample_surface(const PointCloud& cloud, double cell_size, const Context& context) {
    constexpr std::size_t max_samples = 1000;
    const VoxelGrid cells = downsample_voxel_grid(cloud, {.voxel_size = cell_size}, context);
    const std::size_t num_cells = cells.cloud.size();
    const std::size_t stride = std::max<std::size_t>(1, num_cells / max_samples);

    // All neighbours that count lie within a cell's size of the place (see
    // estimate_scan_statistics).
    const double reach = 2.0 * std::sqrt(3.0) * cell_size;
    const SearchTree tree(cells.cloud.positions);
    std::vector<bool> is_near(num_cells, stride == 1);
    std::vector<Neighbor> around;
    for (std::size_t cell = 0; stride > 1 && cell < num_cells; cell += stride) {
        tree.within_radius(cells.cloud.positions[cell], reach, around);
        for (const Neighbor& neighbor : around)
            is_near[neighbor.index] = true;
    }

    SurfaceSamples samples;
    std::vector<bool> is_sampled(num_cells, false);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const std::uint32_t cell = cells.voxel_of_point[i];
        if (cell == no_voxel || !is_near[cell]) continue;
        samples.points.push_back(cloud.positions[i]);
        if (cell % stride != 0 || is_sampled[cell]) continue;
        is_sampled[cell] = true;
        samples.places.push_back(cloud.positions[i]);
    }
    return samples;
}

struct LocalMeasures {
    double reach = 0.0;  ///< m, distance of the last neighbour
    double spacing = 0.0;
    double residual = -1.0;  ///< negative where the neighbours lie on one line
};

LocalMeasures measure(const std::vector<Eigen::Vector3f>& points, const SearchTree& tree,
                      const Eigen::Vector3f& center, std::vector<Neighbor>& neighbors) {
    tree.nearest(center, num_neighbors, neighbors);
    const auto count = static_cast<double>(neighbors.size());
    LocalMeasures measures;
    measures.reach = std::sqrt(static_cast<double>(neighbors.back().squared_distance));
    // On a surface a disc of the k-th neighbour's radius holds k points: pi r^2 / k area for each.
    measures.spacing = measures.reach * std::sqrt(std::numbers::pi / std::max(count - 1.0, 1.0));
    PlaneMoments moments;
    for (const Neighbor& neighbor : neighbors) {
        moments.add(points[neighbor.index].cast<double>());
    }
    const auto fit = moments.fit();
    constexpr double min_flatness = 0.02;  // variance ratio: below, this is one scan line
    if (fit && fit->variances[1] > min_flatness * fit->variances[2]) {
        // The plane took three degrees of freedom.
        measures.residual = fit->rms * std::sqrt(count / std::max(count - 3.0, 1.0));
    }
    return measures;
}

}  // namespace

ScanStatistics estimate_scan_statistics(const PointCloud& cloud, const Context& context) {
    ScanStatistics statistics;
    std::vector<Eigen::Vector3f> points;
    points.reserve(cloud.size());
    for (const Eigen::Vector3f& point : cloud.positions) {
        if (is_finite(point)) points.push_back(point);
    }
    statistics.num_points = points.size();
    if (points.size() < 3) return statistics;
    statistics.extent = middle_extent(points);
    if (statistics.extent <= 0.0) return statistics;

    // As small and as large as a voxel may be: a cloud in a wrong unit is measured all the same.
    const double cell_size = std::clamp(statistics.extent / cells_along_extent, 1e-6, 1e6);
    const SurfaceSamples samples = sample_surface(cloud, cell_size, context);
    const SearchTree tree(samples.points);
    std::vector<LocalMeasures> measures(samples.places.size());
    parallel_for(context, samples.places.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::vector<Neighbor> neighbors;
        for (std::size_t i = begin; i < end; ++i) {
            measures[i] = measure(samples.points, tree, samples.places[i], neighbors);
        }
    });

    // Stray returns far out (beyond a window, at the end of the scanner's range) fill cells of
    // their own, but no surface. They count only if nearly everything is as thin.
    const auto is_surface = [&](const LocalMeasures& local) { return local.reach <= cell_size; };
    const auto num_surface = std::count_if(measures.begin(), measures.end(), is_surface);
    if (10 * static_cast<std::size_t>(num_surface) >= measures.size()) {
        std::erase_if(measures, [&](const LocalMeasures& local) { return !is_surface(local); });
    }

    std::vector<double> spacings;
    std::vector<double> residuals;
    for (const LocalMeasures& local : measures) {
        spacings.push_back(local.spacing);
        if (local.residual >= 0.0) residuals.push_back(local.residual);
    }
    statistics.point_spacing = quantile(spacings, 0.5);
    statistics.noise = quantile(residuals, smooth_quantile);
    return statistics;
}

}  // namespace roomscribe
