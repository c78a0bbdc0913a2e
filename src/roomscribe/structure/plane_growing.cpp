// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_growing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "roomscribe/core/disjoint_sets.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"
#include "roomscribe/structure/neighbor_graph.hpp"

namespace roomscribe {
namespace {

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t chunk = 4096;
constexpr int max_regrowths = 4;

struct Region {
    Plane plane;
    std::vector<std::uint32_t> points;
};

class Grower {
  public:
    Grower(const PointCloud& cloud, const NeighborGraph& graph,
           const PlaneGrowingSettings& settings, const Context& context)
        : positions_(cloud.positions),
          normals_(cloud.normals),
          settings_(settings),
          context_(context),
          min_normal_cosine_(std::cos(settings.normal_tolerance)),
          graph_(graph),
          owner_(cloud.size(), nobody),
          visited_(cloud.size(), 0) {}

    std::vector<PlanarPatch> run();

  private:
    std::vector<std::uint32_t> seeds() const;
    std::optional<Region> grow_from(std::uint32_t seed);
    Region flood(std::uint32_t seed, const Plane& plane);
    bool fits(std::uint32_t point, const Plane& plane) const;
    bool is_large_enough(const Region& region) const;
    bool are_one_surface(const Region& a, const Region& b, Region& joined) const;
    void merge_touching();
    void claim_rims();
    PlanarPatch finish(Region region) const;

    std::span<const Eigen::Vector3f> positions_;
    std::span<const Eigen::Vector3f> normals_;
    const PlaneGrowingSettings& settings_;
    const Context& context_;
    double min_normal_cosine_;
    const NeighborGraph& graph_;
    std::vector<std::uint32_t> owner_;    ///< per point: number of its region
    std::vector<std::uint32_t> visited_;  ///< per point: last flood that reached it
    std::uint32_t flood_number_ = 0;
    std::vector<Region> regions_;
};

/// Points in the order in which planes start from them: flattest surroundings first. The
/// surroundings are the neighbours' neighbours, since a point's own few neighbours are flat by
/// chance too often.
std::vector<std::uint32_t> Grower::seeds() const {
    const std::size_t count = positions_.size();
    std::vector<float> residual(count);
    parallel_for(context_, count, chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto point = static_cast<std::uint32_t>(i);
            double sum = 0.0;
            for (const std::uint32_t neighbor : graph_.neighbors(point)) {
                const double height = normals_[i].dot(positions_[neighbor] - positions_[i]);
                sum += height * height;
            }
            const auto size = static_cast<double>(graph_.neighbors(point).size());
            residual[i] = static_cast<float>(std::sqrt(sum / std::max(size, 1.0)));
            if (!std::isfinite(residual[i])) residual[i] = std::numeric_limits<float>::infinity();
        }
    });
    std::vector<float> surroundings(residual);
    parallel_for(context_, count, chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (const std::uint32_t neighbor : graph_.neighbors(static_cast<std::uint32_t>(i))) {
                surroundings[i] = std::max(surroundings[i], residual[neighbor]);
            }
        }
    });
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (residual[i] <= settings_.distance_tolerance) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(surroundings[a], a) < std::pair(surroundings[b], b);
    });
    return order;
}

bool Grower::fits(std::uint32_t point, const Plane& plane) const {
    const Eigen::Vector3d normal = normals_[point].cast<double>();
    // A NaN normal fails the comparison.
    return std::abs(normal.dot(plane.normal)) >= min_normal_cosine_ &&
           std::abs(plane.signed_distance(positions_[point].cast<double>())) <=
               settings_.distance_tolerance;
}

/// Everything free that is connected to the seed along points that fit; the plane follows the
/// points.
Region Grower::flood(std::uint32_t seed, const Plane& plane) {
    ++flood_number_;
    Region region{plane, {seed}};
    visited_[seed] = flood_number_;
    PlaneMoments moments;
    moments.add(positions_[seed].cast<double>());
    std::size_t next_fit = static_cast<std::size_t>(settings_.num_neighbors);
    for (std::size_t head = 0; head < region.points.size(); ++head) {
        for (const std::uint32_t point : graph_.neighbors(region.points[head])) {
            if (visited_[point] == flood_number_ || owner_[point] != nobody) continue;
            if (!fits(point, region.plane)) continue;
            visited_[point] = flood_number_;
            region.points.push_back(point);
            moments.add(positions_[point].cast<double>());
        }
        if (region.points.size() < next_fit) continue;
        next_fit = 2 * region.points.size();
        if (const auto fit = moments.fit()) region.plane = fit->plane;
    }
    if (const auto fit = moments.fit()) region.plane = fit->plane;
    return region;
}

std::optional<Region> Grower::grow_from(std::uint32_t seed) {
    Plane plane{normals_[seed].cast<double>().normalized(), 0.0};
    plane.offset = plane.normal.dot(positions_[seed].cast<double>());
    Region region = flood(seed, plane);
    for (int i = 0; i < max_regrowths; ++i) {
        if (static_cast<int>(region.points.size()) < settings_.min_points) return std::nullopt;
        if (!fits(seed, region.plane)) return std::nullopt;
        Region again = flood(seed, region.plane);
        const bool settled =
            again.points.size() <= region.points.size() + region.points.size() / 100;
        region = std::move(again);
        if (settled) break;
    }
    if (!is_large_enough(region)) return std::nullopt;
    return region;
}

bool Grower::is_large_enough(const Region& region) const {
    return static_cast<int>(region.points.size()) >= settings_.min_points &&
           occupied_area(positions_, region.points, region.plane, settings_.cell_size) >=
               settings_.min_area;
}

/// Whether one plane holds nearly all points of both, which growing may have missed by starting on
/// a bend of the surface.
bool Grower::are_one_surface(const Region& a, const Region& b, Region& joined) const {
    constexpr double share_on_plane = 0.9;
    if (std::abs(a.plane.normal.dot(b.plane.normal)) < min_normal_cosine_) return false;
    joined.points = a.points;
    joined.points.insert(joined.points.end(), b.points.begin(), b.points.end());
    const auto fit = fit_plane(positions_, joined.points);
    if (!fit) return false;
    joined.plane = fit->plane;
    const auto holds = [&](const Region& part) {
        const auto on_plane =
            std::count_if(part.points.begin(), part.points.end(),
                          [&](std::uint32_t point) { return fits(point, joined.plane); });
        return static_cast<double>(on_plane) >=
               share_on_plane * static_cast<double>(part.points.size());
    };
    return holds(a) && holds(b);
}

void Grower::merge_touching() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> contacts;
    for (std::uint32_t i = 0; i < owner_.size(); ++i) {
        if (owner_[i] == nobody) continue;
        for (const std::uint32_t j : graph_.neighbors(i)) {
            if (owner_[j] != nobody && owner_[i] < owner_[j]) ++contacts[{owner_[i], owner_[j]}];
        }
    }
    std::vector<std::pair<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>> pairs;
    pairs.reserve(contacts.size());
    for (const auto& [pair, count] : contacts)
        pairs.emplace_back(count, pair);
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });

    DisjointSets sets(regions_.size());
    for (const auto& [count, pair] : pairs) {
        const std::uint32_t a = sets.find(pair.first);
        const std::uint32_t b = sets.find(pair.second);
        Region joined;
        if (a == b || !are_one_surface(regions_[a], regions_[b], joined)) continue;
        sets.join(a, b);
        regions_[a] = std::move(joined);
        regions_[b].points.clear();
    }
    for (std::uint32_t& owner : owner_) {
        if (owner != nobody) owner = sets.find(owner);
    }
}

void Grower::claim_rims() {
    const std::vector<std::uint32_t> before = owner_;
    for (std::uint32_t i = 0; i < before.size(); ++i) {
        if (before[i] != nobody) continue;
        double nearest = settings_.distance_tolerance;
        for (const std::uint32_t neighbor : graph_.neighbors(i)) {
            const std::uint32_t region = before[neighbor];
            if (region == nobody) continue;
            const double distance =
                std::abs(regions_[region].plane.signed_distance(positions_[i].cast<double>()));
            if (distance > nearest || (distance == nearest && owner_[i] <= region)) continue;
            nearest = distance;
            owner_[i] = region;
        }
        if (owner_[i] != nobody) regions_[owner_[i]].points.push_back(i);
    }
}

PlanarPatch Grower::finish(Region region) const {
    std::sort(region.points.begin(), region.points.end());
    PlanarPatch patch;
    patch.plane = region.plane;
    if (const auto fit = fit_plane(positions_, region.points)) {
        patch.plane = fit->plane;
        patch.centroid = fit->centroid;
        patch.rms = fit->rms;
    }
    std::ptrdiff_t votes = 0;
    for (const std::uint32_t point : region.points) {
        const double cosine = normals_[point].cast<double>().dot(patch.plane.normal);
        if (std::abs(cosine) >= min_normal_cosine_) votes += cosine > 0.0 ? 1 : -1;
    }
    if (votes < 0) patch.plane = patch.plane.flipped();
    patch.area = occupied_area(positions_, region.points, patch.plane, settings_.cell_size);
    patch.points = std::move(region.points);
    return patch;
}

std::vector<PlanarPatch> Grower::run() {
    const std::vector<std::uint32_t> order = seeds();
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i % chunk == 0) context_.throw_if_cancelled();
        if (owner_[order[i]] != nobody) continue;
        auto region = grow_from(order[i]);
        if (!region) continue;
        for (const std::uint32_t point : region->points) {
            owner_[point] = static_cast<std::uint32_t>(regions_.size());
        }
        regions_.push_back(std::move(*region));
    }
    merge_touching();
    claim_rims();

    std::vector<PlanarPatch> patches;
    for (Region& region : regions_) {
        if (!region.points.empty()) patches.push_back(finish(std::move(region)));
    }
    std::stable_sort(patches.begin(), patches.end(),
                     [](const PlanarPatch& a, const PlanarPatch& b) { return a.area > b.area; });
    return patches;
}

}  // namespace

std::vector<PlanarPatch> grow_planar_patches(const PointCloud& cloud, const NeighborGraph& graph,
                                             const PlaneGrowingSettings& settings,
                                             const Context& context) {
    check_settings(settings);
    if (cloud.normals.size() != cloud.size()) {
        throw InvalidArgument("cloud", "a cloud without normals", "one normal per point");
    }
    if (!std::all_of(cloud.positions.begin(), cloud.positions.end(), is_finite)) {
        throw InvalidArgument("cloud", "a point that is not finite", "finite points only");
    }
    if (graph.size() != cloud.size()) {
        throw InvalidArgument("graph", "another number of points", "the graph of the cloud");
    }
    return Grower(cloud, graph, settings, context).run();
}

std::vector<PlanarPatch> grow_planar_patches(const PointCloud& cloud,
                                             const PlaneGrowingSettings& settings,
                                             const Context& context) {
    check_settings(settings);
    if (!std::all_of(cloud.positions.begin(), cloud.positions.end(), is_finite)) {
        throw InvalidArgument("cloud", "a point that is not finite", "finite points only");
    }
    const NeighborGraph graph(cloud.positions, SearchTree(cloud.positions), settings.num_neighbors,
                              context);
    return grow_planar_patches(cloud, graph, settings, context);
}

}  // namespace roomscribe
