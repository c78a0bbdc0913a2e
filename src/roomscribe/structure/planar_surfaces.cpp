// SPDX-License-Identifier: MIT
#include "roomscribe/structure/planar_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/structure/neighbor_graph.hpp"
#include "roomscribe/structure/surface_contacts.hpp"
#include "roomscribe/structure/surface_pieces.hpp"

namespace roomscribe {
namespace {

/// A voxel belongs to the patch that has most of its points.
void settle_voxels(const SurfaceSample& sample, PlanarSurfaces& surfaces) {
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> votes(sample.cloud.size());
    for (std::size_t i = 0; i < surfaces.patch_of_point.size(); ++i) {
        if (surfaces.patch_of_point[i] == no_patch) continue;
        auto& of_voxel = votes[sample.voxel_of_point[i]];
        const auto patch = static_cast<std::uint32_t>(surfaces.patch_of_point[i]);
        const auto known = std::find_if(of_voxel.begin(), of_voxel.end(),
                                        [&](const auto& vote) { return vote.first == patch; });
        if (known == of_voxel.end()) {
            of_voxel.emplace_back(patch, 1U);
        } else {
            ++known->second;
        }
    }
    for (PlanarPatch& patch : surfaces.patches)
        patch.points.clear();
    for (std::uint32_t voxel = 0; voxel < votes.size(); ++voxel) {
        if (votes[voxel].empty()) continue;
        const auto most = std::max_element(
            votes[voxel].begin(), votes[voxel].end(), [](const auto& a, const auto& b) {
                return std::pair(a.second, b.first) < std::pair(b.second, a.first);
            });
        surfaces.patches[most->first].points.push_back(voxel);
    }
}

/// Whether a strip is less than two voxels wide: its normals are those of what lies on both sides,
/// along a crease those of no surface.
bool is_narrow(const SurfaceSample& sample, std::span<const std::uint32_t> voxels) {
    const auto fit = fit_plane(sample.cloud.positions, voxels);
    // The variance of an even spread is a twelfth of its width squared.
    return !fit || 12.0 * fit->variances[1] < 4.0 * sample.voxel_size * sample.voxel_size;
}

NeighborGraph graph_of(const SurfaceSample& sample, const PlaneGrowingSettings& settings,
                       const Context& context) {
    return NeighborGraph(sample.cloud.positions, SearchTree(sample.cloud.positions),
                         settings.num_neighbors, context);
}

std::vector<Surface> find_surfaces(const ScanMap& map, const SurfaceSample& sample,
                                   const NeighborGraph& graph, const PlaneGrowingSettings& settings,
                                   const Context& context) {
    std::vector<PlanarPatch> grown = grow_planar_patches(sample.cloud, graph, settings, context);
    std::erase_if(grown, [&](const PlanarPatch& patch) { return is_narrow(sample, patch.points); });
    std::vector<Surface> surfaces =
        split_into_surfaces(map, sample, grown, graph, settings, context);
    merge_touching(map, sample, graph, settings, surfaces);
    return surfaces;
}

/// The points that lie on none of the surfaces, and their numbers in the map. Not those of voxels
/// that surfaces explain for the most part: they are outliers of these.
ScanMap remaining_map(const ScanMap& map, const SurfaceSample& sample,
                      std::span<const Surface> surfaces, std::vector<std::uint32_t>& numbers) {
    constexpr double explained = 0.7;
    std::vector<bool> is_taken(map.cloud.size(), false);
    std::vector<std::uint32_t> num_taken(sample.cloud.size(), 0);
    std::vector<std::uint32_t> num_points(sample.cloud.size(), 0);
    for (const Surface& surface : surfaces) {
        for (const std::uint32_t point : surface.map_points) {
            is_taken[point] = true;
            ++num_taken[sample.voxel_of_point[point]];
        }
    }
    for (const std::uint32_t voxel : sample.voxel_of_point) {
        if (voxel != no_voxel) ++num_points[voxel];
    }
    ScanMap rest;
    for (MapSection section : map.sections) {
        const auto first = static_cast<std::uint32_t>(numbers.size());
        for (std::uint32_t i = section.first; i < section.first + section.count; ++i) {
            const std::uint32_t voxel = sample.voxel_of_point[i];
            if (voxel == no_voxel || is_taken[i] ||
                num_taken[voxel] > explained * num_points[voxel]) {
                continue;
            }
            numbers.push_back(i);
            rest.cloud.positions.push_back(map.cloud.positions[i]);
        }
        section.first = first;
        section.count = static_cast<std::uint32_t>(numbers.size()) - first;
        rest.sections.push_back(std::move(section));
    }
    return rest;
}

/// Points of no patch that lie on one that has a voxel beside theirs: creases and rims, where the
/// normals of voxels say nothing.
void claim_rims(const ScanMap& map, const SurfaceSample& sample, const NeighborGraph& graph,
                std::span<const Surface> surfaces, PlanarSurfaces& result, const Context& context) {
    constexpr double max_deviations = 3.0;
    const float reach = static_cast<float>(1.5 * sample.voxel_size);
    const std::vector<std::uint32_t> owner = owners_of_voxels(sample, surfaces);
    parallel_for(context, map.cloud.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t voxel = sample.voxel_of_point[i];
            if (voxel == no_voxel || result.patch_of_point[i] != no_patch) continue;
            const Eigen::Vector3d point = map.cloud.positions[i].cast<double>();
            const double noise =
                std::max(static_cast<double>(sample.noise_of_voxel[voxel]), surface_roughness);
            double best = max_deviations * noise;
            const auto consider = [&](std::uint32_t beside) {
                if (owner[beside] == no_surface) return;
                const double distance =
                    std::abs(result.patches[owner[beside]].plane.signed_distance(point));
                if (distance >= best) return;
                best = distance;
                result.patch_of_point[i] = static_cast<std::int32_t>(owner[beside]);
            };
            consider(voxel);
            for (const std::uint32_t beside : graph.neighbors(voxel)) {
                const Eigen::Vector3f offset =
                    sample.cloud.positions[beside] - map.cloud.positions[i];
                if (offset.norm() <= reach) consider(beside);
            }
        }
    });
}

/// Frames and the edges of boards are narrower than the voxels: what is left is looked at once more
/// with finer ones.
void add_narrow_surfaces(const ScanMap& map, const SurfaceSample& sample,
                         PlaneGrowingSettings settings, std::vector<Surface>& surfaces,
                         const Context& context) {
    std::vector<std::uint32_t> numbers;
    const ScanMap rest = remaining_map(map, sample, surfaces, numbers);
    SurfaceSample fine = sample_surface(rest,
                                        {.num_points = numbers.size(),
                                         .point_spacing = 0.5 * sample.voxel_size,
                                         .noise = sample.noise,
                                         .extent = 0.0},
                                        {.voxel_size = 0.5 * sample.voxel_size}, context);
    fine.noise = sample.noise;
    settings.cell_size = 2.0 * fine.spacing;
    if (fine.cloud.empty()) return;
    std::vector<Surface> narrow =
        find_surfaces(rest, fine, graph_of(fine, settings, context), settings, context);
    for (Surface& surface : narrow) {
        for (std::uint32_t& point : surface.map_points)
            point = numbers[point];
        surfaces.push_back(std::move(surface));
    }
}

}  // namespace

PlanarSurfaces find_planar_surfaces(const ScanMap& map, const SurfaceSample& sample,
                                    const PlaneGrowingSettings& settings, const Context& context) {
    PlanarSurfaces result;
    result.patch_of_point.assign(map.cloud.size(), no_patch);
    if (sample.cloud.empty()) return result;
    const NeighborGraph graph = graph_of(sample, settings, context);
    std::vector<Surface> surfaces = find_surfaces(map, sample, graph, settings, context);
    add_narrow_surfaces(map, sample, settings, surfaces, context);
    merge_touching(map, sample, graph, settings, surfaces);
    std::stable_sort(surfaces.begin(), surfaces.end(), [](const Surface& a, const Surface& b) {
        return a.patch.area > b.patch.area;
    });
    for (Surface& surface : surfaces) {
        for (const std::uint32_t point : surface.map_points)
            result.patch_of_point[point] = static_cast<std::int32_t>(result.patches.size());
        result.patches.push_back(std::move(surface.patch));
    }
    claim_rims(map, sample, graph, surfaces, result, context);
    settle_voxels(sample, result);
    return result;
}

}  // namespace roomscribe
