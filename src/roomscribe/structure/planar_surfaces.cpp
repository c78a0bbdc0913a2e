// SPDX-License-Identifier: MIT
#include "roomscribe/structure/planar_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/structure/neighbor_graph.hpp"
#include "roomscribe/structure/relief_layers.hpp"

namespace roomscribe {
namespace {

constexpr std::uint32_t nobody = 0xFFFFFFFFU;
/// Skirting boards, pictures and frames stand out of their wall by up to this.
constexpr double relief_reach = 0.03;
/// Fewest voxels of a patch.
constexpr std::size_t min_voxels = 8;
/// Surfaces are even over such a stretch, m.
constexpr double min_tile_size = 0.25;
/// Plaster, wood and paint are rough by so much.
constexpr double roughness = 0.001;
/// What bends, folds or has steps deviates from a plane by more than this multiple of the noise.
constexpr double max_bend = 1.5;

/// Per voxel the patches it may have points of: its own and those of its neighbours.
class PatchCandidates {
  public:
    PatchCandidates(std::span<const PlanarPatch> patches, const NeighborGraph& graph)
        : candidates_(graph.size()) {
        std::vector<std::uint32_t> owner(graph.size(), nobody);
        for (std::uint32_t p = 0; p < patches.size(); ++p) {
            for (const std::uint32_t voxel : patches[p].points)
                owner[voxel] = p;
        }
        for (std::uint32_t voxel = 0; voxel < graph.size(); ++voxel) {
            candidates_[voxel].fill(nobody);
            add(voxel, owner[voxel]);
            for (const std::uint32_t neighbor : graph.neighbors(voxel))
                add(voxel, owner[neighbor]);
        }
    }

    std::span<const std::uint32_t> of(std::uint32_t voxel) const { return candidates_[voxel]; }

  private:
    void add(std::uint32_t voxel, std::uint32_t patch) {
        if (patch == nobody) return;
        for (std::uint32_t& slot : candidates_[voxel]) {
            if (slot == patch) return;
            if (slot == nobody) {
                slot = patch;
                return;
            }
        }
    }

    std::vector<std::array<std::uint32_t, 4>> candidates_;
};

/// The map's points voxel by voxel, those of no voxel left out.
std::vector<std::uint32_t> sort_by_voxel(const SurfaceSample& sample) {
    std::vector<std::uint32_t> next(sample.cloud.size() + 1, 0);
    for (const std::uint32_t voxel : sample.voxel_of_point) {
        if (voxel != no_voxel) ++next[voxel + 1];
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<std::uint32_t> points(next.back());
    for (std::uint32_t i = 0; i < sample.voxel_of_point.size(); ++i) {
        if (sample.voxel_of_point[i] != no_voxel) points[next[sample.voxel_of_point[i]]++] = i;
    }
    return points;
}

/// The map's points by the grown patch whose plane they are nearest to, voxel by voxel.
std::vector<std::vector<std::uint32_t>> share_out(const ScanMap& map, const SurfaceSample& sample,
                                                  std::span<const PlanarPatch> patches,
                                                  const PatchCandidates& candidates, double reach,
                                                  const Context& context) {
    std::vector<std::uint32_t> nearest(map.cloud.size(), nobody);
    parallel_for(context, nearest.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t voxel = sample.voxel_of_point[i];
            if (voxel == no_voxel) continue;
            const Eigen::Vector3d point = map.cloud.positions[i].cast<double>();
            double best = reach;
            for (const std::uint32_t patch : candidates.of(voxel)) {
                if (patch == nobody) break;
                const double distance = std::abs(patches[patch].plane.signed_distance(point));
                if (distance >= best) continue;
                best = distance;
                nearest[i] = patch;
            }
        }
    });
    std::vector<std::vector<std::uint32_t>> points(patches.size());
    for (const std::uint32_t i : sort_by_voxel(sample)) {
        if (nearest[i] != nobody) points[nearest[i]].push_back(i);
    }
    return points;
}

/// A patch and the map's points on it.
struct Surface {
    PlanarPatch patch;
    std::vector<std::uint32_t> map_points;
    std::vector<Eigen::Vector3f> middles;  ///< of its points, by voxel
};

/// Plane, centroid, area and rms from points and middles; false if these lie on one line.
bool fit_surface(const ScanMap& map, const Eigen::Vector3d& facing, double cell_size,
                 Surface& surface) {
    const auto fit = fit_plane(surface.middles);
    if (!fit) return false;
    PlanarPatch& patch = surface.patch;
    patch.plane = fit->plane.normal.dot(facing) < 0.0 ? fit->plane.flipped() : fit->plane;
    patch.centroid = fit->centroid;
    std::vector<std::uint32_t> all(surface.middles.size());
    std::iota(all.begin(), all.end(), 0U);
    patch.area = occupied_area(surface.middles, all, patch.plane, cell_size);
    double squares = 0.0;
    for (const std::uint32_t point : surface.map_points) {
        const double height =
            patch.plane.signed_distance(map.cloud.positions[point].cast<double>());
        squares += height * height;
    }
    patch.rms = std::sqrt(squares / static_cast<double>(surface.map_points.size()));
    return true;
}

/// The points of one layer, by voxel.
struct LayerVoxel {
    std::uint32_t voxel;
    std::uint32_t first;  ///< in the layer's sorted points
    std::uint32_t count;
    Eigen::Vector3f middle;
};

class LayerSplitter {
  public:
    LayerSplitter(const ScanMap& map, const SurfaceSample& sample,
                  const PlaneGrowingSettings& settings)
        : map_(map),
          sample_(sample),
          settings_(settings),
          tile_size_(std::max(min_tile_size, 6.0 * sample.spacing)) {}

    /// The connected pieces of every layer near a grown patch. The points come voxel by voxel.
    std::vector<Surface> split(const PlanarPatch& grown, std::span<const std::uint32_t> points,
                               const Context& context) const {
        std::vector<ReliefPoint> relief;
        relief.reserve(points.size());
        for (const std::uint32_t point : points)
            relief.push_back({point, sample_.noise_of_voxel[sample_.voxel_of_point[point]]});
        const ReliefLayers layers =
            find_relief_layers(map_.cloud.positions, relief, grown.plane, tile_size_);
        std::vector<std::vector<std::uint32_t>> points_of(layers.num_layers);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (layers.layer_of_point[i] != no_layer)
                points_of[layers.layer_of_point[i]].push_back(points[i]);
        }
        std::vector<Surface> surfaces;
        for (const auto& of_layer : points_of)
            add_pieces(of_layer, grown, surfaces, context);
        return surfaces;
    }

  private:
    std::vector<LayerVoxel> gather_voxels(std::span<const std::uint32_t> points) const {
        std::vector<LayerVoxel> voxels;
        for (std::uint32_t begin = 0; begin < points.size();) {
            const std::uint32_t voxel = sample_.voxel_of_point[points[begin]];
            std::uint32_t end = begin;
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            for (; end < points.size() && sample_.voxel_of_point[points[end]] == voxel; ++end)
                sum += map_.cloud.positions[points[end]].cast<double>();
            voxels.push_back({voxel, begin, end - begin,
                              (sum / static_cast<double>(end - begin)).cast<float>()});
            begin = end;
        }
        return voxels;
    }

    void add_pieces(std::span<const std::uint32_t> points, const PlanarPatch& grown,
                    std::vector<Surface>& surfaces, const Context& context) const {
        if (points.size() < static_cast<std::size_t>(settings_.min_points)) return;
        const std::vector<LayerVoxel> voxels = gather_voxels(points);
        if (voxels.size() < min_voxels) return;
        std::vector<Eigen::Vector3f> middles;
        middles.reserve(voxels.size());
        for (const LayerVoxel& voxel : voxels)
            middles.push_back(voxel.middle);
        const NeighborGraph graph(middles, SearchTree(middles), settings_.num_neighbors, context);
        std::vector<bool> is_visited(voxels.size(), false);
        for (std::uint32_t seed = 0; seed < voxels.size(); ++seed) {
            if (is_visited[seed]) continue;
            std::vector<std::uint32_t> piece{seed};
            is_visited[seed] = true;
            for (std::size_t head = 0; head < piece.size(); ++head) {
                for (const std::uint32_t next : graph.neighbors(piece[head])) {
                    if (is_visited[next]) continue;
                    is_visited[next] = true;
                    piece.push_back(next);
                }
            }
            add_piece(voxels, piece, points, middles, grown, surfaces);
        }
    }

    /// Whether the points deviate from a plane by their noise alone, tile by tile, since a wall may
    /// be out of true.
    bool is_flat(std::span<const LayerVoxel> voxels, std::span<const std::uint32_t> piece,
                 std::span<const std::uint32_t> points, const Plane& plane) const {
        const PlaneAxes axes = plane_axes(plane.normal);
        std::map<std::pair<std::int32_t, std::int32_t>, PlaneMoments> tiles;
        double expected = 0.0;
        double num_points = 0.0;
        for (const std::uint32_t i : piece) {
            const Eigen::Vector3d middle = voxels[i].middle.cast<double>();
            PlaneMoments& tile =
                tiles[{static_cast<std::int32_t>(std::floor(middle.dot(axes.u) / tile_size_)),
                       static_cast<std::int32_t>(std::floor(middle.dot(axes.v) / tile_size_))}];
            for (std::uint32_t k = 0; k < voxels[i].count; ++k)
                tile.add(map_.cloud.positions[points[voxels[i].first + k]].cast<double>());
            const double noise =
                std::max(static_cast<double>(sample_.noise_of_voxel[voxels[i].voxel]), roughness);
            expected += noise * noise * voxels[i].count;
            num_points += voxels[i].count;
        }
        double squares = 0.0;
        double count = 0.0;
        for (const auto& [place, tile] : tiles) {
            constexpr std::size_t enough = 10;
            if (tile.count < enough) continue;
            const auto fit = tile.fit();
            if (!fit) continue;
            squares += fit->rms * fit->rms * static_cast<double>(tile.count);
            count += static_cast<double>(tile.count);
        }
        return count == 0.0 ||
               std::sqrt(squares / count) <= max_bend * std::sqrt(expected / num_points);
    }

    void add_piece(std::span<const LayerVoxel> voxels, std::span<const std::uint32_t> piece,
                   std::span<const std::uint32_t> points, std::span<const Eigen::Vector3f> middles,
                   const PlanarPatch& grown, std::vector<Surface>& surfaces) const {
        if (piece.size() < min_voxels) return;
        Surface surface;
        for (const std::uint32_t i : piece) {
            surface.middles.push_back(middles[i]);
            const auto first = points.begin() + voxels[i].first;
            surface.map_points.insert(surface.map_points.end(), first, first + voxels[i].count);
        }
        if (surface.map_points.size() < static_cast<std::size_t>(settings_.min_points) ||
            !fit_surface(map_, grown.plane.normal, settings_.cell_size, surface) ||
            surface.patch.area < settings_.min_area ||
            !is_flat(voxels, piece, points, surface.patch.plane)) {
            return;
        }
        surfaces.push_back(std::move(surface));
    }

    const ScanMap& map_;
    const SurfaceSample& sample_;
    const PlaneGrowingSettings& settings_;
    double tile_size_;
};

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

/// The surface that has most of a voxel's points; nobody where there is none.
std::vector<std::uint32_t> owners_of_voxels(const SurfaceSample& sample,
                                            std::span<const Surface> surfaces) {
    std::vector<std::uint32_t> owner(sample.cloud.size(), nobody);
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

/// Where two surfaces touch.
struct Contact {
    std::uint32_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
};

/// Growing may cut a surface in two, which the layers then bring into one plane again.
void merge_touching(const ScanMap& map, const SurfaceSample& sample, const NeighborGraph& graph,
                    double cell_size, std::vector<Surface>& surfaces) {
    constexpr std::uint32_t min_contacts = 4;
    const double min_cosine = std::cos(radians(2.0));
    const std::vector<std::uint32_t> owner = owners_of_voxels(sample, surfaces);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Contact> contacts;
    for (std::uint32_t i = 0; i < owner.size(); ++i) {
        if (owner[i] == nobody) continue;
        for (const std::uint32_t j : graph.neighbors(i)) {
            if (owner[j] == nobody || owner[i] >= owner[j]) continue;
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
        if (step > std::max(sample.noise, roughness)) continue;
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
    const std::vector<std::vector<std::uint32_t>> points =
        share_out(map, sample, grown, PatchCandidates(grown, graph),
                  settings.distance_tolerance + relief_reach, context);
    const LayerSplitter splitter(map, sample, settings);
    std::vector<std::vector<Surface>> pieces(grown.size());
    Context alone = context;
    alone.num_threads = 1;
    parallel_for(context, grown.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            pieces[i] = splitter.split(grown[i], points[i], alone);
    });
    std::vector<Surface> surfaces;
    for (auto& of_patch : pieces) {
        std::move(of_patch.begin(), of_patch.end(), std::back_inserter(surfaces));
    }
    merge_touching(map, sample, graph, settings.cell_size, surfaces);
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
                std::max(static_cast<double>(sample.noise_of_voxel[voxel]), roughness);
            double best = max_deviations * noise;
            const auto consider = [&](std::uint32_t beside) {
                if (owner[beside] == nobody) return;
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
    merge_touching(map, sample, graph, settings.cell_size, surfaces);
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
