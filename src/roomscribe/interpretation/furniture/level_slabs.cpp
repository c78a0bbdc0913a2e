// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/level_slabs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "roomscribe/core/disjoint_sets.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"
#include "roomscribe/interpretation/furniture/slab_cuts.hpp"

namespace roomscribe {
namespace {

/// m above the floor: plinths and rails under tables are lower than any seat or top.
constexpr double min_slab_height = 0.25;
/// m2 and m: half of a stool's seat (0.35 m across) and the half of its width.
constexpr double min_slab_area = 0.05;
constexpr double min_slab_width = 0.16;
/// m: a plate is 18 to 40 mm thick, so what differs by more is another surface; half of it besides
/// noise is for boards that sag.
constexpr double level_step = 0.02;
/// m: the shadow of a monitor or a box on a top.
constexpr double max_shadow = 0.6;
/// Share of the rectangle around two pieces of a top that they have to fill.
constexpr double min_joint_fill = 0.6;

/// Of what was seen sparsely, squares of twice the voxel's edge count.
double area_of(const FurnitureVoxels& all, std::span<const std::uint32_t> members,
               double voxel_size) {
    const double cell_size = 2.0 * voxel_size;
    std::vector<std::pair<std::int32_t, std::int32_t>> cells;
    for (const std::uint32_t i : members) {
        const Eigen::Vector3d& place = all.voxels[i].place;
        cells.emplace_back(static_cast<std::int32_t>(std::floor(place.x() / cell_size)),
                           static_cast<std::int32_t>(std::floor(place.y() / cell_size)));
    }
    std::sort(cells.begin(), cells.end());
    const auto count = std::unique(cells.begin(), cells.end()) - cells.begin();
    // Cells on the rim are filled by half.
    const double by_voxels = voxel_size * voxel_size * static_cast<double>(members.size());
    return std::max(by_voxels, 0.75 * cell_size * cell_size * static_cast<double>(count));
}

LevelSlab make_slab(const FurnitureVoxels& all, std::vector<std::uint32_t> members,
                    double voxel_size) {
    LevelSlab slab;
    slab.rectangle = smallest_rectangle(places_of(all, members));
    std::vector<double> heights;
    heights.reserve(members.size());
    for (const std::uint32_t i : members)
        heights.push_back(all.voxels[i].height);
    slab.height = median(heights);
    const auto down = std::count_if(members.begin(), members.end(),
                                    [&](std::uint32_t i) { return all.voxels[i].looks_down; });
    slab.looks_down = 2 * static_cast<std::size_t>(down) > members.size();
    slab.area = area_of(all, members, voxel_size);
    slab.voxels = std::move(members);
    return slab;
}

/// Grows over level voxels at nearly one height.
std::vector<std::vector<std::uint32_t>> grow_slabs(const FurnitureVoxels& all) {
    std::vector<std::vector<std::uint32_t>> sets;
    std::vector<bool> is_taken(all.voxels.size(), false);
    std::vector<std::uint32_t> stack;
    const auto may_belong = [&](std::uint32_t i) {
        const FurnitureVoxel& voxel = all.voxels[i];
        return !is_taken[i] && voxel.is_core && voxel.is_level && voxel.height >= min_slab_height;
    };
    for (std::uint32_t seed = 0; seed < all.voxels.size(); ++seed) {
        if (!may_belong(seed)) continue;
        std::vector<std::uint32_t>& members = sets.emplace_back();
        double sum = 0.0;
        is_taken[seed] = true;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::uint32_t at = stack.back();
            stack.pop_back();
            const FurnitureVoxel& voxel = all.voxels[at];
            members.push_back(at);
            sum += voxel.height;
            const double mean = sum / static_cast<double>(members.size());
            for (const std::uint32_t next : all.neighbors_of(at)) {
                const FurnitureVoxel& other = all.voxels[next];
                const double step = level_step + other.noise;
                if (!may_belong(next) || other.room != voxel.room) continue;
                if (std::abs(other.height - voxel.height) > step) continue;
                if (std::abs(other.height - mean) > 1.5 * step) continue;
                is_taken[next] = true;
                stack.push_back(next);
            }
        }
        std::sort(members.begin(), members.end());
    }
    return sets;
}

bool fits_a_table(const PlanRectangle& rectangle) {
    return rectangle.width <= max_table_width && rectangle.length <= max_table_length;
}

/// Joins pieces of one top: at one height, a shadow apart, and together no larger than a table.
void join_shadowed(const FurnitureVoxels& all, std::vector<LevelSlab>& slabs, double voxel_size) {
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        for (std::size_t j = i + 1; j < slabs.size();) {
            const LevelSlab& a = slabs[i];
            const LevelSlab& b = slabs[j];
            const FurnitureVoxel& of_a = all.voxels[a.voxels.front()];
            const FurnitureVoxel& of_b = all.voxels[b.voxels.front()];
            const double step = level_step + 0.5 * std::max(of_a.noise, of_b.noise);
            const double gap = a.rectangle.distance(b.rectangle.center) -
                               0.5 * std::hypot(b.rectangle.length, b.rectangle.width);
            bool joins = of_a.storey == of_b.storey && of_a.room == of_b.room &&
                         std::abs(a.height - b.height) <= step && gap <= max_shadow;
            if (joins) {
                std::vector<std::uint32_t> both = a.voxels;
                both.insert(both.end(), b.voxels.begin(), b.voxels.end());
                std::sort(both.begin(), both.end());
                LevelSlab joint = make_slab(all, std::move(both), voxel_size);
                const bool is_seats =
                    a.height < min_table_height &&
                    std::min(a.rectangle.length, b.rectangle.length) <= max_seat_width;
                joins = (is_seats ? joint.rectangle.length <= max_seat_width
                                  : fits_a_table(joint.rectangle)) &&
                        joint.area >= min_joint_fill * joint.rectangle.area();
                if (joins) slabs[i] = std::move(joint);
            }
            if (!joins) {
                ++j;
                continue;
            }
            slabs.erase(slabs.begin() + static_cast<std::ptrdiff_t>(j));
            j = i + 1;
        }
    }
}

/// Joins crumbs of a top that was seen at a grazing angle, in rows a hand's breadth apart: at one
/// height and no further from each other. What is no crumb stays as it is.
std::vector<std::vector<std::uint32_t>> join_sparse(const FurnitureVoxels& all,
                                                    std::vector<std::vector<std::uint32_t>> pieces,
                                                    double voxel_size) {
    constexpr double max_crumb_area = 0.1;  // m2
    constexpr double max_gap = 0.2;         // m
    std::vector<std::uint32_t> crumbs;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        const double area = voxel_size * voxel_size * static_cast<double>(pieces[i].size());
        const bool is_high = all.voxels[pieces[i].front()].height >= min_table_height;
        if (area < max_crumb_area && is_high && pieces[i].size() > 1) crumbs.push_back(i);
    }
    DisjointSets sets(pieces.size());
    const auto are_near = [&](const std::vector<std::uint32_t>& a,
                              const std::vector<std::uint32_t>& b) {
        for (const std::uint32_t i : a) {
            const FurnitureVoxel& of_a = all.voxels[i];
            for (const std::uint32_t j : b) {
                const FurnitureVoxel& of_b = all.voxels[j];
                if (of_a.room != of_b.room || of_a.storey != of_b.storey) return false;
                if (std::abs(of_a.height - of_b.height) > level_step + of_a.noise) continue;
                const Eigen::Vector2d gap = (of_a.place - of_b.place).head<2>();
                if (gap.squaredNorm() <= max_gap * max_gap) return true;
            }
        }
        return false;
    };
    for (std::size_t i = 0; i < crumbs.size(); ++i) {
        for (std::size_t j = i + 1; j < crumbs.size(); ++j) {
            const Eigen::Vector3d between = all.voxels[pieces[crumbs[i]].front()].place -
                                            all.voxels[pieces[crumbs[j]].front()].place;
            if (between.head<2>().norm() > 2.0 * max_table_length) continue;
            if (std::abs(between.z()) > 0.1) continue;
            if (are_near(pieces[crumbs[i]], pieces[crumbs[j]])) sets.join(crumbs[i], crumbs[j]);
        }
    }
    for (const std::uint32_t i : crumbs) {
        const std::uint32_t kept = sets.find(i);
        if (kept == i) continue;
        pieces[kept].insert(pieces[kept].end(), pieces[i].begin(), pieces[i].end());
        pieces[i].clear();
    }
    for (std::vector<std::uint32_t>& piece : pieces)
        std::sort(piece.begin(), piece.end());
    return pieces;
}

/// Parts a slab that is no single rectangle, or larger than any table, and its parts.
void part_slab(const FurnitureVoxels& all, LevelSlab slab, double voxel_size,
               std::vector<LevelSlab>& parts) {
    const std::vector<Eigen::Vector2d> places = places_of(all, slab.voxels);
    const std::optional<SlabCut> cut = choose_slab_cut(all, places, slab, voxel_size);
    std::vector<std::uint32_t> low;
    std::vector<std::uint32_t> high;
    if (cut) {
        for (std::size_t i = 0; i < places.size(); ++i)
            (places[i].dot(cut->direction) < cut->at ? low : high).push_back(slab.voxels[i]);
    }
    if (low.empty() || high.empty()) {
        parts.push_back(std::move(slab));
        return;
    }
    part_slab(all, make_slab(all, std::move(low), voxel_size), voxel_size, parts);
    part_slab(all, make_slab(all, std::move(high), voxel_size), voxel_size, parts);
}

}  // namespace

std::vector<LevelSlab> find_level_slabs(const FurnitureVoxels& all, double voxel_size) {
    // Pieces that a shadow parts may be small; what is left alone and small is dropped below.
    constexpr double min_piece_area = 0.02;
    std::vector<LevelSlab> slabs;
    for (std::vector<std::uint32_t>& members : join_sparse(all, grow_slabs(all), voxel_size)) {
        const double area = voxel_size * voxel_size * static_cast<double>(members.size());
        if (area < min_piece_area) continue;
        part_slab(all, make_slab(all, std::move(members), voxel_size), voxel_size, slabs);
    }
    const auto is_larger = [](const LevelSlab& a, const LevelSlab& b) {
        return a.voxels.size() > b.voxels.size();
    };
    std::stable_sort(slabs.begin(), slabs.end(), is_larger);
    join_shadowed(all, slabs, voxel_size);
    slabs.erase(std::remove_if(slabs.begin(), slabs.end(),
                               [](const LevelSlab& slab) {
                                   return slab.area < min_slab_area ||
                                          slab.rectangle.width < min_slab_width;
                               }),
                slabs.end());
    std::stable_sort(slabs.begin(), slabs.end(), is_larger);
    return slabs;
}

double share_within(const FurnitureVoxels& all, const LevelSlab& slab,
                    const PlanRectangle& rectangle, double margin) {
    std::size_t inside = 0;
    for (const std::uint32_t i : slab.voxels)
        inside += rectangle.distance(all.voxels[i].place.head<2>()) <= margin ? 1U : 0U;
    return static_cast<double>(inside) / static_cast<double>(slab.voxels.size());
}

}  // namespace roomscribe
