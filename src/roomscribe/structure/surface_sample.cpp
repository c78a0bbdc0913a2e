// SPDX-License-Identifier: MIT
#include "roomscribe/structure/surface_sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/preprocessing/normal_estimation.hpp"
#include "roomscribe/preprocessing/scanner_up.hpp"

namespace roomscribe {
namespace {

constexpr double min_voxel_size = 0.04;
constexpr double wall_unevenness = 0.01;
/// Of the sights of a surface from its front, those from behind from which on nobody knows which is
/// which: its other face was not scanned.
constexpr double two_sided_share = 0.25;

bool knows_all_sensors(const ScanMap& map) {
    return !map.sections.empty() &&
           std::all_of(map.sections.begin(), map.sections.end(), [](const MapSection& section) {
               return section.sensor_position.has_value();
           });
}

/// How often the points of a voxel were seen from the side that its normal looks to, and from the
/// other one.
struct SidesSeen {
    std::int32_t front = 0;
    std::int32_t back = 0;
};

/// Turns each normal to the side from which most of the voxel's points were seen, by scanners or
/// inferred views. Returns the voxels' sides then.
std::vector<SidesSeen> face_where_seen(const ScanMap& map, SurfaceSample& sample) {
    std::vector<SidesSeen> sides(sample.cloud.size());
    const auto count = [&](std::uint32_t point, const Eigen::Vector3f& eye) {
        const std::uint32_t voxel = sample.voxel_of_point[point];
        if (voxel == no_voxel) return;
        const Eigen::Vector3f ray = eye - map.cloud.positions[point];
        ++(sample.cloud.normals[voxel].dot(ray) >= 0.0F ? sides[voxel].front : sides[voxel].back);
    };
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position) continue;
        const Eigen::Vector3f sensor = section.sensor_position->cast<float>();
        for (std::uint32_t i = section.first; i < section.first + section.count; ++i)
            count(i, sensor);
    }
    for (const InferredView& view : map.inferred_views) {
        const Eigen::Vector3f place = view.position.cast<float>();
        for (const std::uint32_t point : view.points)
            count(point, place);
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i].front >= sides[i].back) continue;
        std::swap(sides[i].front, sides[i].back);
        sample.cloud.normals[i] = -sample.cloud.normals[i];
    }
    return sides;
}

Eigen::Vector3d find_usual_up(const ScanMap& map) {
    std::vector<UsualUp> ups;
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position || !section.sensor_axes) continue;
        const std::span positions =
            std::span(map.cloud.positions).subspan(section.first, section.count);
        ups.push_back(usual_up(positions, *section.sensor_position, *section.sensor_axes));
    }
    return common_up(ups);
}

double lower_quartile(std::vector<float> values) {
    std::erase_if(values, [](float value) { return !std::isfinite(value); });
    return static_cast<double>(quantile(values, 0.25));
}

/// Per voxel the standard deviation of its points along its normal; NaN for fewer than 4 points.
std::vector<float> spread_in_voxels(const ScanMap& map, const SurfaceSample& sample) {
    constexpr std::uint32_t enough = 4;
    std::vector<double> squares(sample.cloud.size(), 0.0);
    std::vector<std::uint32_t> counts(sample.cloud.size(), 0);
    for (std::size_t i = 0; i < map.cloud.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel) continue;
        const Eigen::Vector3f offset = map.cloud.positions[i] - sample.cloud.positions[voxel];
        const double height = static_cast<double>(sample.cloud.normals[voxel].dot(offset));
        squares[voxel] += height * height;
        ++counts[voxel];
    }
    std::vector<float> spread(squares.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < spread.size(); ++i) {
        if (counts[i] >= enough)
            spread[i] = static_cast<float>(std::sqrt(squares[i] / (counts[i] - 1.0)));
    }
    return spread;
}

/// How a voxel was seen: from how far, and at which angle. Of several scanners the last counts.
struct Sight {
    float range = 0.0F;
    float cosine = 0.0F;
};

std::vector<Sight> find_sights(const ScanMap& map, const SurfaceSample& sample) {
    std::vector<Sight> sights(sample.cloud.size());
    for (const MapSection& section : map.sections) {
        const Eigen::Vector3f sensor = section.sensor_position->cast<float>();
        for (std::uint32_t i = section.first; i < section.first + section.count; ++i) {
            const std::uint32_t voxel = sample.voxel_of_point[i];
            if (voxel == no_voxel) continue;
            const Eigen::Vector3f ray = sensor - map.cloud.positions[i];
            const float range = ray.norm();
            sights[voxel] = {range, std::abs(sample.cloud.normals[voxel].dot(ray)) / range};
        }
    }
    return sights;
}

/// A scanner's noise lies along its rays and depends on the range: across a surface it is the less
/// the more obliquely that is seen.
std::vector<float> noise_of_sight(const ScanMap& map, const SurfaceSample& sample) {
    std::vector<float> noise(sample.cloud.size(), static_cast<float>(sample.noise));
    if (!knows_all_sensors(map)) return noise;
    // Bins of half a doubling from 2 cm on.
    constexpr std::size_t num_bins = 32;
    constexpr std::size_t enough = 50;
    constexpr float min_cosine = 0.4F;
    const auto bin_of = [](float range) {
        const double bin = 2.0 * std::log2(std::max(static_cast<double>(range), 0.02) / 0.02);
        return static_cast<std::size_t>(std::min(bin, static_cast<double>(num_bins - 1)));
    };
    const std::vector<Sight> sights = find_sights(map, sample);
    const std::vector<float> spread = spread_in_voxels(map, sample);
    std::vector<std::vector<float>> along_ray(num_bins);
    for (std::size_t i = 0; i < spread.size(); ++i) {
        if (std::isfinite(spread[i]) && sights[i].cosine >= min_cosine)
            along_ray[bin_of(sights[i].range)].push_back(spread[i] / sights[i].cosine);
    }
    std::vector<float> of_bin(num_bins, 0.0F);
    for (std::size_t bin = 0; bin < num_bins; ++bin) {
        if (along_ray[bin].size() >= enough) of_bin[bin] = median(along_ray[bin]);
    }
    for (std::size_t i = 0; i < noise.size(); ++i) {
        if (std::isfinite(sights[i].cosine))
            noise[i] = std::max(noise[i], of_bin[bin_of(sights[i].range)] * sights[i].cosine);
    }
    return noise;
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
    sample.usual_up = find_usual_up(map);
    if (sample.cloud.empty()) return sample;

    const SearchTree tree(sample.cloud.positions);
    const NormalSettings normal_settings{.num_neighbors = settings.num_neighbors};
    PointNormals found = estimate_normals(sample.cloud.positions, tree, Eigen::Vector3d::Zero(),
                                          normal_settings, context);
    sample.cloud.normals = std::move(found.normals);
    // Quantised ranges look free of noise point by point, but not over several voxels.
    sample.noise = std::max(sample.noise, lower_quartile(std::move(found.residuals)));
    sample.tolerance = plane_tolerance(sample.noise);
    sample.normals_face_scanner = knows_all_sensors(map);
    if (sample.normals_face_scanner) face_where_seen(map, sample);
    sample.noise_of_voxel = noise_of_sight(map, sample);
    return sample;
}

bool face_inferred_views(const ScanMap& map, SurfaceSample& sample,
                         std::span<PlanarPatch> patches) {
    if (map.inferred_views.empty() || !sample.sensor_positions.empty()) return false;
    sample.normals_face_scanner = true;
    const std::vector<SidesSeen> sides = face_where_seen(map, sample);
    for (PlanarPatch& patch : patches) {
        const auto agrees = [&](std::uint32_t voxel) {
            return sample.cloud.normals[voxel].dot(patch.plane.normal.cast<float>()) >= 0.0F;
        };
        std::int64_t front = 0;
        std::int64_t back = 0;
        for (const std::uint32_t voxel : patch.points) {
            front += agrees(voxel) ? sides[voxel].front : sides[voxel].back;
            back += agrees(voxel) ? sides[voxel].back : sides[voxel].front;
        }
        patch.may_face_both_ways = static_cast<double>(std::min(front, back)) >=
                                   two_sided_share * static_cast<double>(std::max(front, back));
        if (front < back) patch.plane = patch.plane.flipped();
        // What no view sees looks where the rest of its surface does.
        for (const std::uint32_t voxel : patch.points) {
            if (sides[voxel].front == 0 && !agrees(voxel))
                sample.cloud.normals[voxel] = -sample.cloud.normals[voxel];
        }
    }
    return true;
}

}  // namespace roomscribe
