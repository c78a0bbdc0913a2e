// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scan_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"
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

/// m, walls are not smooth farther than from one pier, door or cupboard to the next: within more,
/// shape is taken for noise, above all of a cloud that is thin and large.
constexpr double max_smooth_radius = 0.3;

/// Of the finite points; some hundred thousand of them are enough.
double middle_extent(const std::vector<Eigen::Vector3f>& points) {
    const std::size_t stride = std::max<std::size_t>(1, points.size() / 200'000);
    Eigen::Vector3d size;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        std::vector<double> coordinates;
        for (std::size_t i = 0; i < points.size(); i += stride) {
            if (is_finite(points[i])) coordinates.push_back(points[i][axis]);
        }
        const double low = quantile(coordinates, 0.01);
        size[axis] = quantile(coordinates, 0.99) - low;
    }
    return size.norm();
}

/// The points of a cloud cell by cell, on a grid so coarse that the neighbours that count lie in
/// the cells around: to look among those is quicker than to build a tree over all points.
class CellLists {
  public:
    CellLists(const PointCloud& cloud, double cell_size, const Context& context)
        : points_(cloud.positions),
          grid_(downsample_voxel_grid(cloud, {.voxel_size = cell_size}, context)),
          tree_(grid_.cloud.positions),
          reach_(2.0 * std::sqrt(3.0) * cell_size) {
        starts_.reserve(grid_.num_points.size() + 1);
        for (const std::uint32_t count : grid_.num_points)
            starts_.push_back(starts_.back() + count);
        members_.resize(starts_.back());
        std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            const std::uint32_t cell = grid_.voxel_of_point[i];
            if (cell != no_voxel) members_[next[cell]++] = i;
        }
    }

    std::size_t size() const { return grid_.num_points.size(); }

    /// The points around the first point of a cell, that point among them: the nearest of them come
    /// first, the farthest of these last, and their number is returned. It is less than
    /// num_neighbors where there are fewer in the cells around; in a cloud so thin that this is no
    /// exception, the search goes on until it has them all.
    std::size_t neighbors_of(std::size_t cell, std::vector<Neighbor>& neighbors) const {
        const bool is_thin = members_.size() < num_neighbors * size();
        const std::size_t num_wanted = is_thin ? std::min(num_neighbors, members_.size()) : 1;
        for (double reach = reach_;; reach *= 2.0) {
            gather(cell, reach, neighbors);
            if (neighbors.size() >= num_wanted) break;
        }
        const std::size_t count = std::min(num_neighbors, neighbors.size());
        const auto last = neighbors.begin() + static_cast<std::ptrdiff_t>(count) - 1;
        std::nth_element(neighbors.begin(), last, neighbors.end(),
                         [](const Neighbor& a, const Neighbor& b) {
                             return a.squared_distance < b.squared_distance;
                         });
        return count;
    }

  private:
    /// All points of the cells within reach of a cell, with their distances to its first point.
    void gather(std::size_t cell, double reach, std::vector<Neighbor>& neighbors) const {
        const Eigen::Vector3f& place = points_[members_[starts_[cell]]];
        std::vector<Neighbor> cells_around;
        tree_.within_radius(grid_.cloud.positions[cell], reach, cells_around);
        neighbors.clear();
        for (const Neighbor& around : cells_around) {
            for (std::size_t i = starts_[around.index]; i < starts_[around.index + 1]; ++i) {
                neighbors.push_back({members_[i], (points_[members_[i]] - place).squaredNorm()});
            }
        }
    }

    const std::vector<Eigen::Vector3f>& points_;
    VoxelGrid grid_;
    SearchTree tree_;
    double reach_;
    std::vector<std::size_t> starts_{0};
    std::vector<std::uint32_t> members_;  ///< cell after cell
};

struct LocalMeasures {
    std::size_t num_neighbors = 0;
    double reach = 0.0;  ///< m, distance of the last neighbour
    double spacing = 0.0;
    double residual = -1.0;  ///< negative where the points lie on one line
};

/// Standard deviation of points about their plane; negative where they lie on one line.
double plane_residual(const std::vector<Eigen::Vector3f>& points,
                      std::span<const Neighbor> neighbors) {
    // More points tell no more.
    constexpr std::size_t max_points = 100;
    const std::size_t stride = 1 + neighbors.size() / max_points;
    PlaneMoments moments;
    double count = 0.0;
    for (std::size_t i = 0; i < neighbors.size(); i += stride) {
        moments.add(points[neighbors[i].index].cast<double>());
        count += 1.0;
    }
    const auto fit = moments.fit();
    constexpr double min_flatness = 0.02;  // variance ratio: below, this is one scan line
    if (!fit || fit->variances[1] <= min_flatness * fit->variances[2]) return -1.0;
    // The plane took three degrees of freedom.
    return fit->rms * std::sqrt(count / std::max(count - 3.0, 1.0));
}

/// The first `num_nearest` neighbours are the nearest, the farthest of them last. Noise shows
/// within `radius`: a depth camera's nearest points can all lie on one step of its depth.
LocalMeasures measure(const std::vector<Eigen::Vector3f>& points, std::vector<Neighbor>& neighbors,
                      std::size_t num_nearest, double radius) {
    const auto count = static_cast<double>(num_nearest);
    LocalMeasures measures;
    const float squared_reach = neighbors[num_nearest - 1].squared_distance;
    measures.reach = std::sqrt(static_cast<double>(squared_reach));
    measures.num_neighbors = num_nearest;
    // On a surface a disc of the k-th neighbour's radius holds k points: pi r^2 / k area for each.
    measures.spacing = measures.reach * std::sqrt(std::numbers::pi / std::max(count - 1.0, 1.0));
    const float squared_radius = std::max(squared_reach, static_cast<float>(radius * radius));
    std::erase_if(neighbors, [squared_radius](const Neighbor& neighbor) {
        return neighbor.squared_distance > squared_radius;
    });
    measures.residual = plane_residual(points, neighbors);
    return measures;
}

}  // namespace

ScanStatistics estimate_scan_statistics(const PointCloud& cloud, const Context& context) {
    ScanStatistics statistics;
    statistics.num_points = finite_points(cloud).size();
    if (statistics.num_points < 3) return statistics;
    statistics.extent = middle_extent(cloud.positions);
    if (statistics.extent <= 0.0) return statistics;

    // As small and as large as a voxel may be: a cloud in a wrong unit is measured all the same.
    const double cell_size = std::clamp(statistics.extent / cells_along_extent, 1e-6, 1e6);
    const double smooth_radius = std::min(cell_size, max_smooth_radius);
    const CellLists cells(cloud, cell_size, context);
    // Every occupied cell counts once, so that the dense zone near the scanner does not decide; a
    // thousand of them are enough.
    const std::size_t stride = std::max<std::size_t>(1, cells.size() / 1000);
    std::vector<LocalMeasures> measures((cells.size() + stride - 1) / stride);
    parallel_for(context, measures.size(), 16, [&](std::size_t begin, std::size_t end) {
        std::vector<Neighbor> neighbors;
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t num_nearest = cells.neighbors_of(i * stride, neighbors);
            measures[i] = measure(cloud.positions, neighbors, num_nearest, smooth_radius);
        }
    });

    // Stray returns far out (beyond a window, at the end of the scanner's range) fill cells of
    // their own, but no surface. They count only if nearly everything is as thin.
    const std::size_t min_neighbors = std::min(num_neighbors, statistics.num_points);
    const auto is_surface = [&](const LocalMeasures& local) {
        return local.num_neighbors == min_neighbors && local.reach <= cell_size;
    };
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
