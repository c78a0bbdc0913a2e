// SPDX-License-Identifier: MIT
#include "roomscribe/structure/surface_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

constexpr std::uint32_t nobody = 0xFFFFFFFFU;
/// Skirting boards, pictures and frames stand out of their wall by up to this.
constexpr double relief_reach = 0.03;
/// Fewest voxels of a patch.
constexpr std::size_t min_voxels = 8;
/// Surfaces are even over such a stretch, m.
constexpr double min_tile_size = 0.25;
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
    std::vector<std::size_t> counts(patches.size(), 0);
    for (const std::uint32_t patch : nearest) {
        if (patch != nobody) ++counts[patch];
    }
    std::vector<std::vector<std::uint32_t>> points(patches.size());
    for (std::size_t patch = 0; patch < patches.size(); ++patch)
        points[patch].reserve(counts[patch]);
    for (const std::uint32_t i : sort_by_voxel(sample)) {
        if (nearest[i] != nobody) points[nearest[i]].push_back(i);
    }
    return points;
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
    LayerSplitter(const ScanMap& map, const SurfaceSample& sample, const NeighborGraph& graph,
                  const PlaneGrowingSettings& settings)
        : map_(map),
          sample_(sample),
          graph_(graph),
          settings_(settings),
          tile_size_(std::max(min_tile_size, 6.0 * sample.spacing)) {}

    /// The connected pieces of every layer near a grown patch. The points come voxel by voxel.
    /// They are taken, for they are many.
    std::vector<Surface> split(const PlanarPatch& grown, std::vector<std::uint32_t> points) const {
        std::vector<std::vector<std::uint32_t>> points_of = sort_by_layer(grown, points);
        points = {};
        std::vector<Surface> surfaces;
        for (auto& of_layer : points_of) {
            add_pieces(of_layer, grown, surfaces);
            of_layer = {};
        }
        return surfaces;
    }

  private:
    std::vector<std::vector<std::uint32_t>> sort_by_layer(
        const PlanarPatch& grown, std::span<const std::uint32_t> points) const {
        std::vector<ReliefPoint> relief;
        relief.reserve(points.size());
        for (const std::uint32_t point : points)
            relief.push_back({point, sample_.noise_of_voxel[sample_.voxel_of_point[point]]});
        const ReliefLayers layers =
            find_relief_layers(map_.cloud.positions, relief, grown.plane, tile_size_);
        relief = {};
        std::vector<std::size_t> counts(layers.num_layers, 0);
        for (const std::uint32_t layer : layers.layer_of_point) {
            if (layer != no_layer) ++counts[layer];
        }
        std::vector<std::vector<std::uint32_t>> points_of(layers.num_layers);
        for (std::size_t layer = 0; layer < counts.size(); ++layer)
            points_of[layer].reserve(counts[layer]);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (layers.layer_of_point[i] != no_layer)
                points_of[layers.layer_of_point[i]].push_back(points[i]);
        }
        return points_of;
    }

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
                    std::vector<Surface>& surfaces) const {
        if (points.size() < static_cast<std::size_t>(settings_.min_points)) return;
        const std::vector<LayerVoxel> voxels = gather_voxels(points);
        if (voxels.size() < min_voxels) return;
        const auto place_of = [&voxels](std::uint32_t voxel) {
            return std::lower_bound(
                voxels.begin(), voxels.end(), voxel,
                [](const LayerVoxel& known, std::uint32_t number) { return known.voxel < number; });
        };
        std::vector<bool> is_visited(voxels.size(), false);
        for (std::uint32_t seed = 0; seed < voxels.size(); ++seed) {
            if (is_visited[seed]) continue;
            std::vector<std::uint32_t> piece{seed};
            is_visited[seed] = true;
            for (std::size_t head = 0; head < piece.size(); ++head) {
                for (const std::uint32_t voxel : graph_.neighbors(voxels[piece[head]].voxel)) {
                    const auto next = place_of(voxel);
                    if (next == voxels.end() || next->voxel != voxel) continue;
                    const auto number = static_cast<std::uint32_t>(next - voxels.begin());
                    if (is_visited[number]) continue;
                    is_visited[number] = true;
                    piece.push_back(number);
                }
            }
            add_piece(voxels, piece, points, grown, surfaces);
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
            const double noise = std::max(
                static_cast<double>(sample_.noise_of_voxel[voxels[i].voxel]), surface_roughness);
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
                   std::span<const std::uint32_t> points, const PlanarPatch& grown,
                   std::vector<Surface>& surfaces) const {
        if (piece.size() < min_voxels) return;
        Surface surface;
        std::size_t count = 0;
        for (const std::uint32_t i : piece)
            count += voxels[i].count;
        surface.map_points.reserve(count);
        for (const std::uint32_t i : piece) {
            surface.middles.push_back(voxels[i].middle);
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
    const NeighborGraph& graph_;
    const PlaneGrowingSettings& settings_;
    double tile_size_;
};

}  // namespace

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

std::vector<Surface> split_into_surfaces(const ScanMap& map, const SurfaceSample& sample,
                                         std::span<const PlanarPatch> grown,
                                         const NeighborGraph& graph,
                                         const PlaneGrowingSettings& settings,
                                         const Context& context) {
    std::vector<std::vector<std::uint32_t>> points =
        share_out(map, sample, grown, PatchCandidates(grown, graph),
                  settings.distance_tolerance + relief_reach, context);
    const LayerSplitter splitter(map, sample, graph, settings);
    std::vector<std::vector<Surface>> pieces(grown.size());
    parallel_for(context, grown.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            pieces[i] = splitter.split(grown[i], std::move(points[i]));
    });
    std::vector<Surface> surfaces;
    for (auto& of_patch : pieces) {
        std::move(of_patch.begin(), of_patch.end(), std::back_inserter(surfaces));
    }
    return surfaces;
}

}  // namespace roomscribe
