// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/door_sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/openings/face_axes.hpp"

namespace roomscribe {
namespace {

/// m, of the profile's bins; how many lie within the hole and out of it.
constexpr double bin = 0.01;
constexpr std::size_t bins_inward = 14;
constexpr std::size_t bins_outward = 32;
constexpr std::size_t num_bins = bins_inward + bins_outward;
constexpr double inward = bin * bins_inward;
constexpr double outward = bin * bins_outward;
/// Bins of a casing: architraves are 44 to 95 mm wide, block frames to 120 mm.
constexpr std::size_t narrowest = 4;
constexpr std::size_t widest = 13;
/// m. A hole is known to about a cell of the wall's relief.
constexpr double most_shift = 0.15;
constexpr double most_narrowing = 0.05;
/// m before and behind the face of the wall, of what belongs to wall and casing.
constexpr double most_before = 0.06;
constexpr double most_behind = 0.06;
constexpr std::size_t min_in_bin = 4;

/// Median depths across an edge, from within the hole outwards.
class EdgeProfile {
  public:
    EdgeProfile(std::span<const EdgePoint> points, double deepest) {
        std::array<std::vector<float>, num_bins> depths;
        for (const EdgePoint& point : points) {
            const double place = (static_cast<double>(point.outward) + inward) / bin;
            if (place < 0.0 || place >= static_cast<double>(num_bins)) continue;
            if (point.depth < -most_before || point.depth > deepest) continue;
            depths[static_cast<std::size_t>(place)].push_back(point.depth);
        }
        for (std::size_t i = 0; i < num_bins; ++i) {
            const std::size_t count = depths[i].size();
            const bool is_seen = count >= min_in_bin;
            const double level = is_seen ? static_cast<double>(median(depths[i])) : 0.0;
            counts_[i + 1] = counts_[i] + static_cast<double>(count);
            seen_[i + 1] = seen_[i] + (is_seen ? 1.0 : 0.0);
            sums_[i + 1] = sums_[i] + level;
            squares_[i + 1] = squares_[i] + level * level;
        }
    }

    /// m outward, of the inner edge of a bin.
    static double place_of(std::size_t number) {
        return static_cast<double>(number) * bin - inward;
    }
    static std::size_t bin_at(double place) {
        return static_cast<std::size_t>(std::lround((place + inward) / bin));
    }
    /// Points in one of the bins [first, last), on average.
    double mean_count(std::size_t first, std::size_t last) const {
        return (counts_[last] - counts_[first]) / static_cast<double>(last - first);
    }
    /// Whether enough was seen in half of the bins.
    bool is_seen(std::size_t first, std::size_t last) const {
        return 2.0 * (seen_[last] - seen_[first]) >= static_cast<double>(last - first);
    }
    double level(std::size_t first, std::size_t last) const {
        return (sums_[last] - sums_[first]) / std::max(1.0, seen_[last] - seen_[first]);
    }
    /// Sum of the squared deviations from one level.
    double error(std::size_t first, std::size_t last) const {
        const double sum = sums_[last] - sums_[first];
        return squares_[last] - squares_[first] -
               sum * sum / std::max(1.0, seen_[last] - seen_[first]);
    }

  private:
    using Sums = std::array<double, num_bins + 1>;
    Sums counts_{};
    Sums seen_{};
    Sums sums_{};
    Sums squares_{};
};

/// The bins [inner, outer) of the casing.
struct Casing {
    std::size_t inner = 0;
    std::size_t outer = 0;
    double error = std::numeric_limits<double>::infinity();
};

/// Bins of the leaf, and of the wall, that must show.
constexpr std::size_t min_bins = 5;

/// Leaf, casing and wall: the three levels that the profile is nearest to.
Casing split_at_leaf(const EdgeProfile& profile) {
    Casing best;
    for (std::size_t inner = min_bins; inner + narrowest + min_bins <= num_bins; ++inner) {
        if (!profile.is_seen(0, inner)) continue;
        for (std::size_t outer = inner + narrowest;
             outer <= std::min(inner + widest, num_bins - min_bins); ++outer) {
            if (!profile.is_seen(inner, outer) || !profile.is_seen(outer, num_bins)) continue;
            const double error = profile.error(0, inner) + profile.error(inner, outer) +
                                 profile.error(outer, num_bins);
            if (error < best.error) best = {inner, outer, error};
        }
    }
    return best;
}

/// The bin at which the wall begins behind a leaf, without a casing.
std::size_t split_at_wall(const EdgeProfile& profile) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t inner = min_bins; inner + min_bins <= num_bins; ++inner) {
        if (!profile.is_seen(0, inner) || !profile.is_seen(inner, num_bins)) continue;
        const double error = profile.error(0, inner) + profile.error(inner, num_bins);
        if (error < least) {
            least = error;
            best = inner;
        }
    }
    return best;
}

/// The first bin outwards from where there is next to nothing in the hole.
std::size_t edge_of_hole(const EdgeProfile& profile) {
    // Farther out, shadows of the casing would pass for the hole.
    const double usual = profile.mean_count(EdgeProfile::bin_at(0.0), EdgeProfile::bin_at(0.05));
    std::size_t inner = EdgeProfile::bin_at(0.03);
    while (inner > 0 && profile.mean_count(inner - 1, inner) >= 0.3 * usual)
        --inner;
    return inner;
}

/// Casing and wall, from the edge of the hole outwards.
Casing split_at_hole(const EdgeProfile& profile) {
    Casing best;
    const std::size_t inner = edge_of_hole(profile);
    for (std::size_t outer = inner + narrowest;
         outer <= std::min(inner + widest, num_bins - min_bins); ++outer) {
        if (!profile.is_seen(inner, outer) || !profile.is_seen(outer, num_bins)) continue;
        const double error = profile.error(inner, outer) + profile.error(outer, num_bins);
        if (error < best.error) best = {inner, outer, error};
    }
    return best;
}

}  // namespace

std::optional<DoorSide> read_door_side(std::span<const EdgePoint> points,
                                       std::optional<double> leaf_depth, double noise) {
    const double deepest = std::max(most_behind, leaf_depth.value_or(0.0) + 3.0 * noise + 0.02);
    const EdgeProfile profile(points, deepest);
    // Three standard errors of a bin's median, and what plaster is uneven by.
    const auto is_step = [&](double a, double b, std::size_t first, std::size_t last) {
        const double per_bin = std::max(1.0, profile.mean_count(first, last));
        return std::abs(a - b) >= std::max(0.004, 3.0 * 1.25 * noise / std::sqrt(per_bin));
    };
    const Casing casing = leaf_depth ? split_at_leaf(profile) : split_at_hole(profile);
    if (casing.outer == 0) return std::nullopt;
    const double depth = profile.level(casing.inner, casing.outer);
    const double wall = profile.level(casing.outer, num_bins);
    const double leaf = profile.level(0, casing.inner);
    // Casings stand before their wall; what lies deeper between it and the leaf is the lining.
    const bool is_casing = depth < wall && is_step(depth, wall, casing.inner, casing.outer) &&
                           (!leaf_depth || is_step(depth, leaf, casing.inner, casing.outer));
    DoorSide side;
    if (is_casing) {
        side = {EdgeProfile::place_of(casing.inner), EdgeProfile::place_of(casing.outer)};
    } else if (!leaf_depth) {
        side.inner = EdgeProfile::place_of(casing.inner);
    } else {
        const std::size_t inner = split_at_wall(profile);
        if (inner == 0 ||
            !is_step(profile.level(0, inner), profile.level(inner, num_bins), 0, num_bins))
            return std::nullopt;
        side.inner = EdgeProfile::place_of(inner);
    }
    // What was seen through is no narrower; leaves that stand open hide its edges.
    const double most_inward = leaf_depth ? most_shift : most_narrowing;
    if (side.inner > most_shift || side.inner < -most_inward) return std::nullopt;
    return side;
}

namespace {

/// The points about the three edges of a door.
struct DoorEdges {
    std::array<std::vector<EdgePoint>, 3> points;  ///< left, right, above
    double noise = 0.0;                            ///< m, sum over the points
    std::size_t num_points = 0;
};

/// Tells which edge of a door a point is beside.
class DoorSurroundings {
  public:
    DoorSurroundings(const WallOpening& opening, const RoomSurfaces& surfaces)
        : hole_(opening.hole), axes_(face_of(opening, surfaces)) {}

    FacePlace place_of(const Eigen::Vector3f& point) const { return axes_.place_of(point); }

    bool is_near(const FacePlace& place, double reach) const {
        return place.depth >= -most_before - reach && place.depth <= 0.2 + reach &&
               place.along >= hole_.start - outward - reach &&
               place.along <= hole_.end + outward + reach && place.above >= hole_.bottom - reach &&
               place.above <= hole_.top + outward + reach;
    }

    void add(const FacePlace& place, DoorEdges& edges) const {
        // Skirtings and thresholds below; corners belong to both edges.
        constexpr double from_corner = 0.15;
        const double along = place.along;
        const double above = place.above;
        if (above >= hole_.bottom + 0.3 && above <= hole_.top - from_corner) {
            const bool is_left = along < 0.5 * (hole_.start + hole_.end);
            const double out = is_left ? hole_.start - along : along - hole_.end;
            if (out >= -inward)
                edges.points[is_left ? 0 : 1].push_back({static_cast<float>(out), place.depth});
        } else if (along >= hole_.start + from_corner && along <= hole_.end - from_corner &&
                   above >= hole_.top - inward) {
            edges.points[2].push_back({static_cast<float>(above - hole_.top), place.depth});
        }
    }

  private:
    WallRectangle hole_;
    FaceAxes axes_;
};

void move_edges(WallOpening& opening, const DoorEdges& edges) {
    if (edges.num_points == 0) return;
    const double noise = edges.noise / static_cast<double>(edges.num_points);
    std::optional<double> leaf_depth;
    if (!opening.is_open && opening.type == OpeningType::door) leaf_depth = opening.depth;
    std::array<std::optional<DoorSide>, 3> sides;
    double widest_side = 0.0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        sides[i] = read_door_side(edges.points[i], leaf_depth, noise);
        if (sides[i] && sides[i]->outer)
            widest_side = std::max(widest_side, *sides[i]->outer - sides[i]->inner);
    }
    // One casing goes around a door; what stands beside it may hide a part of a side.
    opening.has_casing = widest_side > 0.0;
    if (opening.has_casing) opening.frame_width = widest_side;
    if (sides[0]) opening.hole.start -= sides[0]->inner;
    if (sides[1]) opening.hole.end += sides[1]->inner;
    if (sides[2]) opening.hole.top += sides[2]->inner;
}

}  // namespace

void fit_door_sides(const PointCloud& map, const SurfaceSample& sample,
                    const RoomSurfaces& surfaces, std::span<WallOpening> openings,
                    const Context& context) {
    std::vector<std::size_t> doors;
    std::vector<DoorSurroundings> places;
    for (std::size_t i = 0; i < openings.size(); ++i) {
        if (openings[i].type == OpeningType::window || openings[i].is_pane) continue;
        doors.push_back(i);
        places.emplace_back(openings[i], surfaces);
    }
    // The points in the voxels that any door reaches, in their order.
    const double reach = std::sqrt(3.0) * sample.voxel_size;
    std::vector<std::uint8_t> is_near(sample.cloud.size(), 0);
    parallel_for(context, sample.cloud.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector3f& center = sample.cloud.positions[i];
            is_near[i] =
                std::any_of(places.begin(), places.end(), [&](const DoorSurroundings& door) {
                    return door.is_near(door.place_of(center), reach);
                });
        }
    });
    std::vector<std::uint32_t> near;
    for (std::size_t i = 0; i < map.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel != no_voxel && is_near[voxel] != 0) near.push_back(static_cast<std::uint32_t>(i));
    }
    parallel_for(context, doors.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t d = begin; d < end; ++d) {
            DoorEdges edges;
            for (const std::uint32_t i : near) {
                const FacePlace place = places[d].place_of(map.positions[i]);
                if (!places[d].is_near(place, 0.0)) continue;
                places[d].add(place, edges);
                edges.noise += static_cast<double>(sample.noise_of_voxel[sample.voxel_of_point[i]]);
                ++edges.num_points;
            }
            move_edges(openings[doors[d]], edges);
        }
    });
}

}  // namespace roomscribe
