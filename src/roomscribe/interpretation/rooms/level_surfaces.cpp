// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/level_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/upright/axis_profile.hpp"

namespace roomscribe {
namespace {

/// Ramps in buildings rise by at most 6 degrees (10 %); the rest is for the plane's and up's error.
constexpr double max_slope = radians(10.0);
/// Against the largest level, what has less than this share of its area makes no floor or ceiling
/// of its own. A floor under furniture shows at least that much.
constexpr double min_level_share = 0.05;
/// The largest table is larger, but a floor of which less was seen is not worth a name.
constexpr double min_level_area = 0.5;
/// Podiums, ramps and thresholds lie lower than seats (0.4 m and more).
constexpr double max_step = 0.35;
/// Ceilings under a roof slope by up to this much; steeper, it is a wall, unless it begins above a
/// knee wall.
constexpr double max_ceiling_slope = radians(45.0);
/// Storeys are no higher (building practice); above, it is a roof seen from outside.
constexpr double max_room_height = 5.0;
/// Slabs are thicker.
constexpr double min_slab = 0.05;

std::vector<Level> find_levels(std::span<const PlanarPatch> patches, const Eigen::Vector3d& up,
                               bool facing_is_known, double tolerance) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        if (std::abs(patches[i].plane.normal.dot(up)) >= std::cos(max_slope)) order.push_back(i);
    }
    const auto height = [&](std::uint32_t patch) { return patches[patch].centroid.dot(up); };
    // The largest first, so that levels form about floors and not about what lies on them.
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return patches[a].area > patches[b].area;
    });
    std::vector<Level> levels;
    for (const std::uint32_t patch : order) {
        Level* nearest = nullptr;
        double distance = tolerance;
        for (Level& level : levels) {
            if (std::abs(level.height - height(patch)) > distance) continue;
            distance = std::abs(level.height - height(patch));
            nearest = &level;
        }
        if (nearest == nullptr) nearest = &levels.emplace_back();
        const double area = patches[patch].area;
        nearest->height =
            (nearest->height * nearest->area + height(patch) * area) / (nearest->area + area);
        nearest->area += area;
        if (facing_is_known && !patches[patch].may_face_both_ways) {
            nearest->facing_up += patches[patch].plane.normal.dot(up) > 0.0 ? area : -area;
        }
        nearest->patches.push_back(patch);
    }
    std::sort(levels.begin(), levels.end(),
              [](const Level& a, const Level& b) { return a.height < b.height; });
    return levels;
}

/// Each goes to the highest storey over whose floor it rises to a room's height.
void add_sloping_ceilings(std::vector<Storey>& storeys, const SurfaceSample& sample,
                          std::span<const PlanarPatch> patches, const Eigen::Vector3d& up,
                          bool facing_is_known, double room_height) {
    constexpr double stray_share = 0.02;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        const double cosine = patches[i].plane.normal.dot(up);
        const bool looks_up = facing_is_known && !patches[i].may_face_both_ways && cosine > 0.0;
        if (patches[i].area < min_level_area || looks_up) continue;
        if (std::abs(cosine) >= std::cos(max_slope)) continue;
        if (std::abs(cosine) < std::cos(max_roof_slope)) continue;
        std::vector<double> heights;
        for (const std::uint32_t voxel : patches[i].points)
            heights.push_back(sample.cloud.positions[voxel].cast<double>().dot(up));
        const double low = quantile(heights, stray_share);
        const double high = quantile(heights, 1.0 - stray_share);
        const bool is_steep = std::abs(cosine) < std::cos(max_ceiling_slope);
        const auto below = std::find_if(storeys.rbegin(), storeys.rend(), [&](const Storey& s) {
            return s.floor && high >= s.floor->height + room_height &&
                   high <= s.floor->height + max_room_height &&
                   low >= s.floor->height + (is_steep ? min_knee_height : 0.0);
        });
        if (below != storeys.rend()) below->sloping_ceilings.push_back(i);
    }
}

/// Number of a square of the plan of a quarter of a metre.
std::pair<int, int> cell_of(const Eigen::Vector3d& point, const PlaneAxes& axes) {
    constexpr double cell_size = 0.25;
    return {static_cast<int>(std::floor(point.dot(axes.u) / cell_size)),
            static_cast<int>(std::floor(point.dot(axes.v) / cell_size))};
}

/// Cells of the plan, ascending, that a level fills.
std::vector<std::pair<int, int>> cells_of(const Level& level, const SurfaceSample& sample,
                                          std::span<const PlanarPatch> patches,
                                          const Eigen::Vector3d& up) {
    const PlaneAxes axes = plane_axes(up);
    std::vector<std::pair<int, int>> cells;
    for (const std::uint32_t patch : level.patches) {
        for (const std::uint32_t voxel : patches[patch].points) {
            const Eigen::Vector3d point = sample.cloud.positions[voxel].cast<double>();
            cells.push_back(cell_of(point, axes));
        }
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

/// Whether surface goes on under the level or at its rim, as it does under tables and worktops, but
/// not under a floor.
bool stands_on_something(const Level& level, const SurfaceSample& sample,
                         std::span<const PlanarPatch> patches, const Eigen::Vector3d& up) {
    // Of a worktop 0.6 m deep with a front 0.7 m high, most of it seen from above.
    constexpr double min_share_below = 0.25;
    // Thresholds and the noise of floors seen from afar.
    constexpr double clearance = 0.2;
    const std::vector<std::pair<int, int>> cells = cells_of(level, sample, patches, up);
    const PlaneAxes axes = plane_axes(up);
    std::size_t below = 0;
    for (const Eigen::Vector3f& position : sample.cloud.positions) {
        const Eigen::Vector3d point = position.cast<double>();
        if (point.dot(up) > level.height - clearance) continue;
        const auto [x, y] = cell_of(point, axes);
        bool is_under = false;
        for (int i = x - 1; i <= x + 1; ++i) {
            // The cells of a column lie side by side.
            const auto first = std::lower_bound(cells.begin(), cells.end(), std::pair(i, y - 1));
            is_under = is_under || (first != cells.end() && *first <= std::pair(i, y + 1));
        }
        below += is_under ? 1 : 0;
    }
    std::size_t num_voxels = 0;
    for (const std::uint32_t patch : level.patches)
        num_voxels += patches[patch].points.size();
    return static_cast<double>(below) >= min_share_below * static_cast<double>(num_voxels);
}

/// Ground and terraces: a little of them at most lies under a roof.
constexpr double min_share_under_roof = 0.2;

/// Share of a level's cells that lie under one of the others; 0 of none.
double share_under(const std::vector<std::pair<int, int>>& cells,
                   std::span<const std::vector<std::pair<int, int>>> others) {
    if (cells.empty()) return 0.0;
    const auto is_under = [&](const std::pair<int, int>& cell) {
        return std::any_of(others.begin(), others.end(), [&](const auto& other) {
            return std::binary_search(other.begin(), other.end(), cell);
        });
    };
    return static_cast<double>(std::count_if(cells.begin(), cells.end(), is_under)) /
           static_cast<double>(cells.size());
}

/// Takes out, from below, what looks up under no ceiling while there is a floor above that has one:
/// ground that was seen through a window, however large and however little below the floor.
void drop_open_ground(std::vector<const Level*>& levels, const SurfaceSample& sample,
                      std::span<const PlanarPatch> patches, const Eigen::Vector3d& up) {
    std::vector<std::vector<std::pair<int, int>>> ceilings;
    for (const Level* level : levels) {
        if (level->facing_up < 0.0) ceilings.push_back(cells_of(*level, sample, patches, up));
    }
    const auto is_roofed = [&](const Level* level) {
        return share_under(cells_of(*level, sample, patches, up), ceilings) >= min_share_under_roof;
    };
    const auto is_floor_above = [&](const Level* level) {
        return level != levels.front() && level->facing_up > 0.0 && is_roofed(level) &&
               !stands_on_something(*level, sample, patches, up);
    };
    while (!levels.empty() && levels.front()->facing_up > 0.0 && !is_roofed(levels.front()) &&
           std::any_of(levels.begin(), levels.end(), is_floor_above)) {
        levels.erase(levels.begin());
    }
}

/// The same where nobody knows which way a surface looks. Takes out, from below, what lies under
/// none of the levels above and is much smaller than one of them. Of two levels neither is it.
void drop_ground(std::vector<const Level*>& levels, const SurfaceSample& sample,
                 std::span<const PlanarPatch> patches, const Eigen::Vector3d& up) {
    const auto is_largest = [&] {
        return std::none_of(levels.begin(), levels.end(), [&](const Level* other) {
            return other->area > 2.0 * levels.front()->area;
        });
    };
    while (levels.size() > 2 && !is_largest()) {
        std::vector<std::vector<std::pair<int, int>>> above;
        for (std::size_t i = 1; i < levels.size(); ++i)
            above.push_back(cells_of(*levels[i], sample, patches, up));
        if (share_under(cells_of(*levels.front(), sample, patches, up), above) >=
            min_share_under_roof)
            return;
        levels.erase(levels.begin());
    }
}

}  // namespace

std::vector<Storey> find_storeys(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                                 const Eigen::Vector3d& up, bool facing_is_known,
                                 const RoomSurfacesSettings& settings) {
    const std::vector<Level> levels =
        find_levels(patches, up, facing_is_known, settings.level_tolerance);
    double largest = 0.0;
    for (const Level& level : levels)
        largest = std::max(largest, level.area);
    std::vector<const Level*> large;
    for (const Level& level : levels) {
        if (level.area >= std::max(min_level_area, min_level_share * largest)) {
            large.push_back(&level);
        }
    }
    if (facing_is_known) {
        drop_open_ground(large, sample, patches, up);
    } else {
        drop_ground(large, sample, patches, up);
    }
    const auto may_be_floor = [](const Level* level) { return level->facing_up >= 0.0; };
    const auto may_be_ceiling = [](const Level* level) { return level->facing_up <= 0.0; };

    std::vector<Storey> storeys(1);
    for (std::size_t i = 0; i < large.size(); ++i) {
        const Level* level = large[i];
        Storey& storey = storeys.back();
        if (!storey.floor && storey.ceilings.empty() && may_be_floor(level)) {
            if (stands_on_something(*level, sample, patches, up)) continue;
            storey.floor = *level;
            continue;
        }
        // Higher than this, it is a seat.
        if (storey.floor && level->height < storey.floor->height + max_step &&
            may_be_floor(level)) {
            storey.other_floors.push_back(*level);
            if (level->area > storey.floor->area)
                std::swap(*storey.floor, storey.other_floors.back());
            continue;
        }
        const bool is_high =
            !storey.floor || level->height >= storey.floor->height + settings.min_room_height;
        if (!is_high) continue;
        const bool has_ceiling_below =
            !storey.ceilings.empty() && storey.ceilings.front().height <= level->height - min_slab;
        const bool has_level_above =
            large.back()->height >= level->height + settings.min_room_height;
        // What looks up so high above the ground with a room over it is no ceiling: the ground
        // outdoors was seen through a window.
        const bool is_upper_floor =
            storey.floor && storey.ceilings.empty() && facing_is_known && level->facing_up > 0.0;
        if ((has_ceiling_below || is_upper_floor) && has_level_above && may_be_floor(level)) {
            storeys.push_back({*level, {}, {}, {}});
        } else if (may_be_ceiling(level)) {
            storey.ceilings.push_back(*level);
        }
    }
    // Ground and terraces have no ceiling; a building has, if any of it was seen.
    const bool has_ceiling = std::any_of(storeys.begin(), storeys.end(),
                                         [](const Storey& s) { return !s.ceilings.empty(); });
    if (has_ceiling) std::erase_if(storeys, [](const Storey& s) { return s.ceilings.empty(); });
    add_sloping_ceilings(storeys, sample, patches, up, facing_is_known, settings.min_room_height);
    return storeys;
}

}  // namespace roomscribe
