// SPDX-License-Identifier: MIT
#include "roomscribe/structure/relief_layers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace roomscribe {
namespace {

/// Stretches of a tile along either side: each counts alike in the tile's density of heights.
constexpr int stretches = 6;
/// Finished walls may be out of true by this (DIN 18202, table 3: 5 mm over 1 m, either way).
constexpr double max_slope = 0.01;
/// A layer's share of a tile, and its points there, at least.
constexpr double min_share = 0.04;
constexpr std::size_t min_mode_points = 6;
/// The modes hold this share of a tile: folds and slopes have points at all heights.
constexpr double min_held_share = 0.6;
/// A valley between two peaks is lower than this share of the lower one.
constexpr double max_valley = 0.7;
/// Points lie about their mode by no more standard deviations.
constexpr double max_deviations = 3.0;

struct Sample {
    double height;
    double noise;
    double weight;
    std::uint32_t number;  ///< in the given points
    std::int32_t stretch;  ///< within its tile
};

struct Mode {
    double height;
    double deviation;  ///< the tile's
    std::vector<std::uint32_t> members;
};

using TilePlace = std::pair<std::int32_t, std::int32_t>;

/// Density of the heights of a tile, smoothed by its standard deviation.
class HeightDensity {
  public:
    HeightDensity(std::span<const Sample> tile, double deviation) : step_(0.5 * deviation) {
        const auto [low, high] = std::minmax_element(
            tile.begin(), tile.end(),
            [](const Sample& a, const Sample& b) { return a.height < b.height; });
        constexpr int margin = 4;
        low_ = low->height - margin * step_;
        const auto num_bins = static_cast<std::size_t>((high->height - low_) / step_) + 1 + margin;
        std::vector<double> bins(num_bins, 0.0);
        for (const Sample& sample : tile)
            bins[bin_of(sample.height)] += sample.weight;
        // Binomial of 8: a normal distribution of 1.4 bins, 0.7 of the deviation.
        constexpr double kernel[] = {70.0, 56.0, 28.0, 8.0, 1.0};
        values_.resize(num_bins, 0.0);
        for (std::size_t i = 0; i < num_bins; ++i) {
            for (int k = -margin; k <= margin; ++k) {
                const auto j = static_cast<std::ptrdiff_t>(i) + k;
                if (j < 0 || j >= static_cast<std::ptrdiff_t>(num_bins)) continue;
                values_[i] += kernel[std::abs(k)] / 256.0 * bins[static_cast<std::size_t>(j)];
            }
        }
    }

    /// Heights of the peaks that valleys part, and of the valleys between them.
    void find_peaks(std::vector<double>& peaks, std::vector<double>& valleys) const {
        std::size_t peak = 0;
        std::size_t valley = 0;
        bool is_falling = false;
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (!is_falling) {
                if (values_[i] > values_[peak]) peak = i;
                if (values_[i] < max_valley * values_[peak]) {
                    is_falling = true;
                    valley = i;
                }
                continue;
            }
            if (values_[i] < values_[valley]) valley = i;
            if (values_[valley] < max_valley * values_[i]) {
                peaks.push_back(height_of(peak));
                valleys.push_back(height_of(valley));
                peak = i;
                is_falling = false;
            }
        }
        peaks.push_back(height_of(peak));
    }

  private:
    std::size_t bin_of(double height) const {
        return static_cast<std::size_t>((height - low_) / step_);
    }
    double height_of(std::size_t bin) const {
        return low_ + (static_cast<double>(bin) + 0.5) * step_;
    }

    double step_;
    double low_ = 0.0;
    std::vector<double> values_;
};

void weigh_stretches(std::span<Sample> tile) {
    std::sort(tile.begin(), tile.end(), [](const Sample& a, const Sample& b) {
        return std::pair(a.stretch, a.number) < std::pair(b.stretch, b.number);
    });
    for (std::size_t begin = 0; begin < tile.size();) {
        std::size_t end = begin;
        while (end < tile.size() && tile[end].stretch == tile[begin].stretch)
            ++end;
        for (std::size_t i = begin; i < end; ++i)
            tile[i].weight = 1.0 / static_cast<double>(end - begin);
        begin = end;
    }
}

std::vector<Mode> find_modes(std::span<Sample> tile) {
    weigh_stretches(tile);
    const double noise =
        std::accumulate(tile.begin(), tile.end(), 0.0,
                        [](double sum, const Sample& sample) { return sum + sample.noise; }) /
        static_cast<double>(tile.size());
    const double deviation = std::max(noise, surface_roughness);
    std::vector<double> peaks;
    std::vector<double> valleys;
    HeightDensity(tile, deviation).find_peaks(peaks, valleys);
    std::vector<Mode> modes(peaks.size());
    std::vector<double> weights(peaks.size(), 0.0);
    std::vector<double> sums(peaks.size(), 0.0);
    double total = 0.0;
    for (const Sample& sample : tile) {
        total += sample.weight;
        const auto mode = static_cast<std::size_t>(
            std::lower_bound(valleys.begin(), valleys.end(), sample.height) - valleys.begin());
        if (std::abs(sample.height - peaks[mode]) > max_deviations * deviation) continue;
        modes[mode].members.push_back(sample.number);
        weights[mode] += sample.weight;
        sums[mode] += sample.weight * sample.height;
    }
    for (std::size_t i = 0; i < modes.size(); ++i) {
        modes[i].height = weights[i] > 0.0 ? sums[i] / weights[i] : 0.0;
        modes[i].deviation = deviation;
        // Of a tile that the surface hardly enters all that is there counts.
        if (weights[i] < min_share * total || modes[i].members.size() < min_mode_points)
            modes[i].members.clear();
    }
    std::erase_if(modes, [](const Mode& mode) { return mode.members.empty(); });
    const double held = std::accumulate(weights.begin(), weights.end(), 0.0);
    return held < min_held_share * total ? std::vector<Mode>{} : modes;
}

class LayerLinks {
  public:
    explicit LayerLinks(std::size_t num_modes) : root_(num_modes) {
        std::iota(root_.begin(), root_.end(), 0U);
    }
    std::uint32_t find(std::uint32_t mode) {
        while (root_[mode] != mode) {
            root_[mode] = root_[root_[mode]];
            mode = root_[mode];
        }
        return mode;
    }
    void join(std::uint32_t a, std::uint32_t b) { root_[find(b)] = find(a); }

  private:
    std::vector<std::uint32_t> root_;
};

/// The mode of the others that is nearest in height; the number of none if there are none.
std::size_t nearest_mode(const Mode& mode, std::span<const Mode> others) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < others.size(); ++i) {
        if (std::abs(others[i].height - mode.height) <
            std::abs(others[best].height - mode.height)) {
            best = i;
        }
    }
    return best;
}

struct Tile {
    std::vector<Mode> modes;
    std::uint32_t first = 0;  ///< number of its first mode among all
};

void link_tiles(const Tile& a, const Tile& b, double tile_size, LayerLinks& links) {
    if (a.modes.empty() || b.modes.empty()) return;
    for (std::size_t i = 0; i < a.modes.size(); ++i) {
        const std::size_t j = nearest_mode(a.modes[i], b.modes);
        if (nearest_mode(b.modes[j], a.modes) != i) continue;
        const double deviation = std::max(a.modes[i].deviation, b.modes[j].deviation);
        if (std::abs(a.modes[i].height - b.modes[j].height) <=
            std::max(deviation, max_slope * tile_size)) {
            links.join(a.first + static_cast<std::uint32_t>(i),
                       b.first + static_cast<std::uint32_t>(j));
        }
    }
}

}  // namespace

ReliefLayers find_relief_layers(std::span<const Eigen::Vector3f> positions,
                                std::span<const ReliefPoint> points, const Plane& plane,
                                double tile_size) {
    ReliefLayers layers;
    layers.layer_of_point.assign(points.size(), no_layer);
    if (points.empty()) return layers;
    const PlaneAxes axes = plane_axes(plane.normal);
    const auto place_of = [&](const Eigen::Vector3d& point) {
        return std::pair(point.dot(axes.u) / tile_size, point.dot(axes.v) / tile_size);
    };
    std::map<TilePlace, std::vector<std::uint32_t>> numbers;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const auto [u, v] = place_of(positions[points[i].point].cast<double>());
        numbers[{static_cast<std::int32_t>(std::floor(u)),
                 static_cast<std::int32_t>(std::floor(v))}]
            .push_back(i);
    }
    std::map<TilePlace, Tile> tiles;
    std::uint32_t num_modes = 0;
    std::vector<Sample> samples;  // of one tile: they are large beside their points
    for (auto& [tile_place, of_tile] : numbers) {
        samples.clear();
        for (const std::uint32_t i : of_tile) {
            const Eigen::Vector3d point = positions[points[i].point].cast<double>();
            const auto [u, v] = place_of(point);
            const int column = static_cast<int>(stretches * (u - std::floor(u)));
            const int row = static_cast<int>(stretches * (v - std::floor(v)));
            samples.push_back({plane.signed_distance(point), static_cast<double>(points[i].noise),
                               1.0, i, row * stretches + column});
        }
        of_tile = {};
        Tile& tile = tiles[tile_place];
        tile.modes = find_modes(samples);
        tile.first = num_modes;
        num_modes += static_cast<std::uint32_t>(tile.modes.size());
    }
    LayerLinks links(num_modes);
    for (const auto& [place, tile] : tiles) {
        for (const TilePlace& next :
             {TilePlace{place.first + 1, place.second}, TilePlace{place.first, place.second + 1}}) {
            const auto neighbor = tiles.find(next);
            if (neighbor != tiles.end()) link_tiles(tile, neighbor->second, tile_size, links);
        }
    }
    std::vector<std::uint32_t> layer_of_mode(num_modes, no_layer);
    for (const auto& [place, tile] : tiles) {
        for (std::size_t i = 0; i < tile.modes.size(); ++i) {
            std::uint32_t& layer =
                layer_of_mode[links.find(tile.first + static_cast<std::uint32_t>(i))];
            if (layer == no_layer) layer = layers.num_layers++;
            for (const std::uint32_t member : tile.modes[i].members)
                layers.layer_of_point[member] = layer;
        }
    }
    return layers;
}

}  // namespace roomscribe
