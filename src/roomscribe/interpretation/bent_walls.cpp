// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/bent_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "roomscribe/core/units.hpp"
#include "roomscribe/structure/neighbor_graph.hpp"

namespace roomscribe {
namespace {

constexpr double max_turn = radians(20.0);
/// From one voxel to the next. Walls are bent by up to this (docs/interpretation.md).
constexpr double max_slope = radians(12.0);
/// Tolerances of planes, from the wall's.
constexpr double max_bend = 3.0;
constexpr int num_neighbors = 8;
/// Voxels farther apart in spacings are no neighbours, however few lie between them.
constexpr double max_gap = 2.5;
constexpr std::int32_t none = -1;

/// Floors do not go on so: what stands on them begins there.
bool may_bend(Label label) {
    return label == Label::ceiling || label == Label::wall;
}

/// Per voxel the wall or ceiling (of RoomSurfaces::surfaces) that its labelled points belong to, or
/// `none`; and whether it may still be given to one: none of its points has a label.
struct VoxelLabels {
    std::vector<std::int32_t> surface;
    std::vector<bool> is_free;
};

VoxelLabels label_voxels(const SurfaceSample& sample, const std::vector<std::int32_t>& surface_of,
                         const PointLabels& labels) {
    VoxelLabels voxels;
    voxels.surface.assign(sample.cloud.size(), none);
    voxels.is_free.assign(sample.cloud.size(), true);
    for (std::size_t i = 0; i < labels.labels.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel || labels.labels[i] == Label::unknown) continue;
        voxels.is_free[voxel] = false;
        const std::int32_t instance = labels.instances[i];
        if (may_bend(labels.labels[i]) && instance >= 0 &&
            static_cast<std::size_t>(instance) < surface_of.size())
            voxels.surface[voxel] = surface_of[static_cast<std::size_t>(instance)];
    }
    return voxels;
}

}  // namespace

void continue_bent_walls(const SurfaceSample& sample, const RoomSurfaces& surfaces,
                         PointLabels& labels, const Context& context) {
    std::vector<std::int32_t> surface_of;  // by instance
    for (std::size_t s = 0; s < surfaces.surfaces.size(); ++s) {
        const Component& component = surfaces.surfaces[s].component;
        if (component.instance < 0) continue;
        const auto instance = static_cast<std::size_t>(component.instance);
        if (instance >= surface_of.size()) surface_of.resize(instance + 1, none);
        surface_of[instance] = static_cast<std::int32_t>(s);
    }
    if (surface_of.empty() || sample.cloud.empty()) return;
    VoxelLabels voxels = label_voxels(sample, surface_of, labels);
    for (std::size_t voxel = 0; voxel < surfaces.is_hung.size(); ++voxel)
        voxels.is_free[voxel] = voxels.is_free[voxel] && !surfaces.is_hung[voxel];
    const std::vector<Eigen::Vector3f>& positions = sample.cloud.positions;
    const SearchTree tree(positions);
    const NeighborGraph graph(positions, tree, num_neighbors, context);
    const auto distance = [&](std::uint32_t voxel, std::int32_t surface) {
        return surfaces.surfaces[static_cast<std::size_t>(surface)].plane.signed_distance(
            positions[voxel].cast<double>());
    };
    const auto goes_on = [&](std::uint32_t from, std::uint32_t to, std::int32_t surface) {
        const Plane& plane = surfaces.surfaces[static_cast<std::size_t>(surface)].plane;
        const double turn = std::abs(sample.cloud.normals[to].cast<double>().dot(plane.normal));
        const double length = static_cast<double>((positions[to] - positions[from]).norm());
        const double step = std::abs(distance(to, surface) - distance(from, surface));
        return turn >= std::cos(max_turn) && length <= max_gap * sample.spacing &&
               step <= length * std::tan(max_slope) + 0.5 * sample.noise &&
               std::abs(distance(to, surface)) <= max_bend * sample.tolerance;
    };
    // In rounds, and of several surfaces the first: the order of the voxels does not matter.
    std::vector<std::uint32_t> rim;
    for (std::uint32_t voxel = 0; voxel < positions.size(); ++voxel) {
        if (voxels.surface[voxel] != none) rim.push_back(voxel);
    }
    while (!rim.empty()) {
        std::map<std::uint32_t, std::int32_t> taken;
        for (const std::uint32_t voxel : rim) {
            for (const std::uint32_t other : graph.neighbors(voxel)) {
                if (!voxels.is_free[other] || !goes_on(voxel, other, voxels.surface[voxel]))
                    continue;
                const auto [entry, is_new] = taken.try_emplace(other, voxels.surface[voxel]);
                if (!is_new) entry->second = std::min(entry->second, voxels.surface[voxel]);
            }
        }
        rim.clear();
        for (const auto& [voxel, surface] : taken) {
            voxels.is_free[voxel] = false;
            voxels.surface[voxel] = surface;
            rim.push_back(voxel);
        }
    }
    for (std::size_t i = 0; i < labels.labels.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel || labels.labels[i] != Label::unknown) continue;
        if (voxels.surface[voxel] == none) continue;
        const Component& component =
            surfaces.surfaces[static_cast<std::size_t>(voxels.surface[voxel])].component;
        labels.labels[i] = component.label;
        labels.instances[i] = component.instance;
        labels.confidences[i] = 0.5F * static_cast<float>(component.confidence);
    }
}

}  // namespace roomscribe
