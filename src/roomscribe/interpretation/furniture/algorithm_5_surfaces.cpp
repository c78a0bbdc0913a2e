// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/algorithm_5_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"
#include "roomscribe/structure/euclidean_clusters.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk = 16384;

/// One point to the plane through it that is perpendicular to an axis.
struct AxisPlaneProblem {
    using Model = Plane;

    std::span<const Eigen::Vector3f> positions;
    std::span<const std::uint32_t> points;
    Eigen::Vector3d axis;
    double tolerance;
    const Context& context;

    std::size_t num_data() const { return points.size(); }
    int sample_size() const { return 1; }

    std::optional<Plane> propose(Random& random) const {
        const std::uint32_t i = random.below(static_cast<std::uint32_t>(points.size()));
        return Plane{axis, axis.dot(positions[points[i]].cast<double>())};
    }

    bool is_inlier(const Plane& plane, std::uint32_t point) const {
        return std::abs(plane.signed_distance(positions[point].cast<double>())) <= tolerance;
    }

    double score(const Plane& plane) const {
        return parallel_reduce(
            context, points.size(), chunk, 0.0,
            [&](std::size_t begin, std::size_t end) {
                std::size_t count = 0;
                for (std::size_t i = begin; i < end; ++i)
                    count += is_inlier(plane, points[i]) ? 1U : 0U;
                return static_cast<double>(count);
            },
            [](double a, double b) { return a + b; });
    }
};

}  // namespace

FurnitureSurfaces detect_furniture_surfaces(const PointCloud& cloud, const Eigen::Matrix3d& axes,
                                            std::uint64_t seed,
                                            const FurnitureSurfaceSettings& settings,
                                            const Context& context) {
    check_settings(settings);
    FurnitureSurfaces result;
    VoxelGrid grid = downsample_voxel_grid(cloud, {.voxel_size = settings.voxel_size}, context);
    result.cloud = std::move(grid.cloud);
    result.voxel_of_point = std::move(grid.voxel_of_point);
    const std::vector<Eigen::Vector3f>& positions = result.cloud.positions;

    const auto min_inliers = static_cast<std::size_t>(settings.min_plane_inliers);
    const auto min_cluster = static_cast<std::size_t>(settings.min_plane_cluster);
    std::vector<std::uint32_t> left(positions.size());
    for (std::uint32_t i = 0; i < left.size(); ++i)
        left[i] = i;
    std::uint64_t draw = seed;
    for (int axis = 0; axis < 3; ++axis) {
        while (left.size() >= min_inliers) {
            context.throw_if_cancelled();
            const AxisPlaneProblem problem{positions, left, axes.row(axis).transpose(),
                                           settings.distance_tolerance, context};
            const auto found = sample_consensus(problem, draw++, settings.consensus);
            if (!found.model || found.score < settings.min_plane_inliers) break;
            std::vector<std::uint32_t> inliers;
            std::vector<std::uint32_t> others;
            for (const std::uint32_t point : left)
                (problem.is_inlier(*found.model, point) ? inliers : others).push_back(point);
            left = std::move(others);
            for (std::vector<std::uint32_t>& cluster :
                 euclidean_clusters(positions, inliers, settings.cluster_tolerance)) {
                if (cluster.size() < min_cluster) continue;
                FurnitureSurface surface;
                const auto fit = fit_plane(positions, cluster);
                surface.plane = fit ? fit->plane : *found.model;
                if (surface.plane.normal.dot(problem.axis) < 0.0)
                    surface.plane = surface.plane.flipped();
                surface.axis = axis;
                surface.points = std::move(cluster);
                result.surfaces.push_back(std::move(surface));
            }
        }
    }
    return result;
}

}  // namespace roomscribe
