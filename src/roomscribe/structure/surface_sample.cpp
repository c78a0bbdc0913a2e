// SPDX-License-Identifier: MIT
#include "roomscribe/structure/surface_sample.hpp"

#include <algorithm>
#include <cmath>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/preprocessing/normal_estimation.hpp"

namespace roomscribe {
namespace {

constexpr double min_voxel_size = 0.04;
constexpr double wall_unevenness = 0.01;

/// Turns each normal to the side from which most of the voxel's points were seen.
void face_scanners(const ScanMap& map, SurfaceSample& sample) {
    std::vector<std::int32_t> votes(sample.cloud.size(), 0);
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position) continue;
        const Eigen::Vector3f sensor = section.sensor_position->cast<float>();
        for (std::uint32_t i = section.first; i < section.first + section.count; ++i) {
            const std::uint32_t voxel = sample.voxel_of_point[i];
            if (voxel == no_voxel) continue;
            const Eigen::Vector3f ray = sensor - map.cloud.positions[i];
            votes[voxel] += sample.cloud.normals[voxel].dot(ray) >= 0.0F ? 1 : -1;
        }
    }
    for (std::size_t i = 0; i < votes.size(); ++i) {
        if (votes[i] < 0) sample.cloud.normals[i] = -sample.cloud.normals[i];
    }
}

double lower_quartile(std::vector<float> values) {
    std::erase_if(values, [](float value) { return !std::isfinite(value); });
    return static_cast<double>(quantile(values, 0.25));
}

}  // namespace

double surface_voxel_size(const ScanStatistics& statistics) {
    return std::max(min_voxel_size, 0.5 * statistics.point_spacing);
}

double plane_tolerance(double noise) {
    return std::hypot(3.0 * noise, wall_unevenness);
}

SurfaceSample sample_surface(const ScanMap& map, const ScanStatistics& statistics,
                             const SurfaceSampleSettings& settings, const Context& context) {
    check_settings(settings);
    SurfaceSample sample;
    sample.voxel_size = settings.voxel_size.value_or(surface_voxel_size(statistics));
    sample.noise = statistics.noise;
    sample.tolerance = plane_tolerance(sample.noise);
    sample.spacing = std::max(sample.voxel_size, statistics.point_spacing);
    VoxelGrid grid = downsample_voxel_grid(map.cloud, {.voxel_size = sample.voxel_size}, context);
    sample.cloud = std::move(grid.cloud);
    sample.voxel_of_point = std::move(grid.voxel_of_point);
    for (const MapSection& section : map.sections) {
        if (section.sensor_position) sample.sensor_positions.push_back(*section.sensor_position);
    }
    if (sample.cloud.empty()) return sample;

    const SearchTree tree(sample.cloud.positions);
    const NormalSettings normal_settings{.num_neighbors = settings.num_neighbors};
    PointNormals found = estimate_normals(sample.cloud.positions, tree, Eigen::Vector3d::Zero(),
                                          normal_settings, context);
    sample.cloud.normals = std::move(found.normals);
    // Quantised ranges look free of noise point by point, but not over several voxels.
    sample.noise = std::max(sample.noise, lower_quartile(std::move(found.residuals)));
    sample.tolerance = plane_tolerance(sample.noise);
    sample.normals_face_scanner =
        !map.sections.empty() &&
        std::all_of(map.sections.begin(), map.sections.end(),
                    [](const MapSection& section) { return section.sensor_position.has_value(); });
    if (sample.normals_face_scanner) face_scanners(map, sample);
    return sample;
}

}  // namespace roomscribe
