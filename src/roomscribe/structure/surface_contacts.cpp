// SPDX-License-Identifier: MIT
#include "roomscribe/structure/surface_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "roomscribe/core/disjoint_sets.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Where two surfaces touch.
struct Contact {
    /// How far apart in height neighbouring voxels of the two lie, across the first one's plane.
    std::vector<float> steps;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();

    Eigen::Vector3d middle() const { return sum / static_cast<double>(steps.size()); }
};

/// Whether one plane holds nearly all voxels of both.
bool are_in_one_plane(const Surface& a, const Surface& b, double tolerance) {
    constexpr double share_on_plane = 0.9;
    std::vector<Eigen::Vector3f> middles = a.middles;
    middles.insert(middles.end(), b.middles.begin(), b.middles.end());
    const auto fit = fit_plane(middles);
    if (!fit) return false;
    const auto holds = [&](const Surface& part) {
        const auto on_plane = std::count_if(
            part.middles.begin(), part.middles.end(), [&](const Eigen::Vector3f& middle) {
                return std::abs(fit->plane.signed_distance(middle.cast<double>())) <= tolerance;
            });
        return static_cast<double>(on_plane) >=
               share_on_plane * static_cast<double>(part.middles.size());
    };
    return holds(a) && holds(b);
}

/// Whether the planes agree where the surfaces touch, or the surfaces go over into each other
/// without a step, as those of a floor that bends do.
bool are_one_surface(const Surface& a, const Surface& b, Contact& contact, double noise,
                     double tolerance) {
    const Plane& plane = a.patch.plane;
    const Plane& other = b.patch.plane;
    const double cosine = plane.normal.dot(other.normal);
    const Eigen::Vector3d middle = contact.middle();
    if (cosine >= std::cos(radians(2.0)) &&
        std::abs(plane.signed_distance(middle) - other.signed_distance(middle)) <= noise) {
        return true;
    }
    return cosine >= std::cos(radians(5.0)) &&
           static_cast<double>(median(contact.steps)) <= noise && are_in_one_plane(a, b, tolerance);
}

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
                    const PlaneGrowingSettings& settings, std::vector<Surface>& surfaces) {
    constexpr std::size_t min_contacts = 4;
    const double noise = std::max(sample.noise, surface_roughness);
    const std::vector<std::uint32_t> owner = owners_of_voxels(sample, surfaces);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Contact> contacts;
    for (std::uint32_t i = 0; i < owner.size(); ++i) {
        if (owner[i] == no_surface) continue;
        const Eigen::Vector3f normal = surfaces[owner[i]].patch.plane.normal.cast<float>();
        for (const std::uint32_t j : graph.neighbors(i)) {
            if (owner[j] == no_surface || owner[i] >= owner[j]) continue;
            Contact& contact = contacts[{owner[i], owner[j]}];
            const Eigen::Vector3f& here = sample.cloud.positions[i];
            contact.steps.push_back(std::abs(normal.dot(sample.cloud.positions[j] - here)));
            contact.sum += here.cast<double>();
        }
    }
    DisjointSets sets(surfaces.size());
    for (auto& [pair, contact] : contacts) {
        const std::uint32_t a = sets.find(pair.first);
        const std::uint32_t b = sets.find(pair.second);
        const std::uint32_t kept = std::min(a, b);
        const std::uint32_t gone = std::max(a, b);
        Surface& whole = surfaces[kept];
        Surface& part = surfaces[gone];
        if (kept == gone || contact.steps.size() < min_contacts ||
            !are_one_surface(whole, part, contact, noise, settings.distance_tolerance)) {
            continue;
        }
        sets.join(kept, gone);
        whole.map_points.insert(whole.map_points.end(), part.map_points.begin(),
                                part.map_points.end());
        whole.middles.insert(whole.middles.end(), part.middles.begin(), part.middles.end());
        part = {};
        fit_surface(map, Eigen::Vector3d(whole.patch.plane.normal), settings.cell_size, whole);
    }
    std::erase_if(surfaces, [](const Surface& surface) { return surface.map_points.empty(); });
}

}  // namespace roomscribe
