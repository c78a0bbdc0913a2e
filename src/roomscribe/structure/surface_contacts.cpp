// SPDX-License-Identifier: MIT
#include "roomscribe/structure/surface_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Where two surfaces touch.
struct Contact {
    std::uint32_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
};

}  // namespace

std::vector<std::uint32_t> owners_of_voxels(const SurfaceSample& sample,
                                            std::span<const Surface> surfaces) {
    std::vector<std::uint32_t> owner(sample.cloud.size(), no_surface);
    std::vector<std::uint32_t> most(sample.cloud.size(), 0);
    std::vector<std::uint32_t> count(sample.cloud.size(), 0);
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
        for (const std::uint32_t point : surfaces[s].map_points)
            ++count[sample.voxel_of_point[point]];
        for (const std::uint32_t point : surfaces[s].map_points) {
            const std::uint32_t voxel = sample.voxel_of_point[point];
            if (count[voxel] > most[voxel]) {
                most[voxel] = count[voxel];
                owner[voxel] = s;
            }
            count[voxel] = 0;
        }
    }
    return owner;
}

void merge_touching(const ScanMap& map, const SurfaceSample& sample, const NeighborGraph& graph,
                    double cell_size, std::vector<Surface>& surfaces) {
    constexpr std::uint32_t min_contacts = 4;
    const double min_cosine = std::cos(radians(2.0));
    const std::vector<std::uint32_t> owner = owners_of_voxels(sample, surfaces);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Contact> contacts;
    for (std::uint32_t i = 0; i < owner.size(); ++i) {
        if (owner[i] == no_surface) continue;
        for (const std::uint32_t j : graph.neighbors(i)) {
            if (owner[j] == no_surface || owner[i] >= owner[j]) continue;
            Contact& contact = contacts[{owner[i], owner[j]}];
            ++contact.count;
            contact.sum += sample.cloud.positions[i].cast<double>();
        }
    }
    std::vector<std::uint32_t> root(surfaces.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&](std::uint32_t s) {
        while (root[s] != s)
            s = root[s];
        return s;
    };
    for (const auto& [pair, contact] : contacts) {
        const std::uint32_t a = find(pair.first);
        const std::uint32_t b = find(pair.second);
        const Plane& plane = surfaces[a].patch.plane;
        const Plane& other = surfaces[b].patch.plane;
        if (a == b || contact.count < min_contacts || plane.normal.dot(other.normal) < min_cosine) {
            continue;
        }
        const Eigen::Vector3d middle = contact.sum / contact.count;
        const double step = std::abs(plane.signed_distance(middle) - other.signed_distance(middle));
        if (step > std::max(sample.noise, surface_roughness)) continue;
        const auto [kept, gone] = std::minmax(a, b);
        Surface& whole = surfaces[kept];
        Surface& part = surfaces[gone];
        root[gone] = kept;
        whole.map_points.insert(whole.map_points.end(), part.map_points.begin(),
                                part.map_points.end());
        whole.middles.insert(whole.middles.end(), part.middles.begin(), part.middles.end());
        part = {};
        fit_surface(map, Eigen::Vector3d(whole.patch.plane.normal), cell_size, whole);
    }
    std::erase_if(surfaces, [](const Surface& surface) { return surface.map_points.empty(); });
}

}  // namespace roomscribe
