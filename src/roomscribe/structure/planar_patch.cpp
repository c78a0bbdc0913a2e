// SPDX-License-Identifier: MIT
#include "roomscribe/structure/planar_patch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roomscribe {
namespace {

/// Mean distance of neighbouring inliers is not known here; their spread over the plane gives it.
double cell_size(const PlaneFit& fit, std::size_t count) {
    const double extent = std::sqrt(12.0 * std::max(fit.variances[1], 1e-12)) *
                          std::sqrt(12.0 * std::max(fit.variances[2], 1e-12));
    return 2.0 * std::sqrt(extent / static_cast<double>(count));
}

}  // namespace

double occupied_area(std::span<const Eigen::Vector3f> positions,
                     std::span<const std::uint32_t> points, const Plane& plane, double cell_size) {
    if (points.empty()) return 0.0;
    const PlaneAxes axes = plane_axes(plane.normal);
    const Eigen::Vector3d origin = positions[points.front()].cast<double>();
    std::vector<std::uint64_t> cells;
    cells.reserve(points.size());
    for (const std::uint32_t point : points) {
        const Eigen::Vector3d offset = positions[point].cast<double>() - origin;
        const auto column = static_cast<std::int32_t>(std::floor(offset.dot(axes.u) / cell_size));
        const auto row = static_cast<std::int32_t>(std::floor(offset.dot(axes.v) / cell_size));
        cells.push_back((static_cast<std::uint64_t>(static_cast<std::uint32_t>(row)) << 32U) |
                        static_cast<std::uint32_t>(column));
    }
    std::sort(cells.begin(), cells.end());
    const auto occupied = std::unique(cells.begin(), cells.end()) - cells.begin();
    return static_cast<double>(occupied) * cell_size * cell_size;
}

PlanarPatch make_planar_patch(const PointCloud& cloud, Plane plane,
                              std::vector<std::uint32_t> inliers) {
    PlanarPatch patch;
    if (const auto fit = fit_plane(cloud.positions, inliers)) {
        plane = fit->plane;
        patch.centroid = fit->centroid;
        patch.rms = fit->rms;
        patch.area =
            occupied_area(cloud.positions, inliers, plane, cell_size(*fit, inliers.size()));
    }
    if (!cloud.normals.empty()) {
        std::ptrdiff_t votes = 0;
        for (const std::uint32_t point : inliers) {
            const double cosine = cloud.normals[point].cast<double>().dot(plane.normal);
            votes += (cosine > 0.0 ? 1 : 0) - (cosine < 0.0 ? 1 : 0);
        }
        if (votes < 0) plane = plane.flipped();
    }
    patch.plane = plane;
    patch.points = std::move(inliers);
    return patch;
}

}  // namespace roomscribe
