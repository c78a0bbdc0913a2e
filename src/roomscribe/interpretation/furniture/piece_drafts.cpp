// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "roomscribe/core/disjoint_sets.hpp"
#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"
#include "roomscribe/interpretation/furniture/row_cuts.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
/// m above the floor, see docs/furniture.md: seats 0.40 to 0.52 with cushions; tables from 0.65,
/// counters to 1.1; a child's table or a low chest between.
constexpr double min_seat = 0.36;
constexpr double max_low = 0.66;
constexpr double max_table = 1.2;
/// m: handles project 25 to 40 mm, tops overhang as much.
constexpr double beside = 0.06;
/// m: a chair's back leans out behind its seat, its castors reach out under it.
constexpr double beside_seat = 0.16;
/// m above a seat to the upper end of a back.
constexpr double back_height = 0.75;
/// m: wall units are 0.6 to 0.9 high.
constexpr double max_unit_height = 1.0;
/// m: boards of a shelf are no further apart (a folder needs 0.32, coats more but behind doors).
constexpr double max_board_gap = 0.65;
/// Fewer voxels tell no thing: 25 of 4 cm are a square of 20 cm.
constexpr std::size_t min_voxels = 25;

bool is_lying_over(double share) {
    return share >= 0.7;
}

/// Boards above each other: alike in length and depth.
bool are_boards(const LevelSlab& a, const LevelSlab& b, double share_of_a, double share_of_b) {
    if (std::abs(a.height - b.height) > max_board_gap) return false;
    const double shorter = std::min(a.rectangle.length, b.rectangle.length);
    const double longer = std::max(a.rectangle.length, b.rectangle.length);
    // A board is as long as its shelf, though books may hide a third of it.
    return shorter >= 0.6 * longer && share_of_a >= 0.6 && share_of_b >= 0.4;
}

/// Arms, backs and headboards: narrow, above a seat or mattress and at its rim.
bool is_rail_of(const LevelSlab& rail, const LevelSlab& seat) {
    constexpr double max_rail_width = 0.36;
    constexpr double max_rise = 0.6;
    const double rise = rail.height - seat.height;
    return seat.height <= max_low && rail.rectangle.width <= max_rail_width &&
           rail.rectangle.length <= seat.rectangle.length + 0.7 && rise >= -0.1 &&
           rise <= max_rise && seat.rectangle.area() > rail.rectangle.area();
}

bool touch(const FurnitureVoxels& all, const LevelSlab& a, const LevelSlab& b,
           double gap = 2.0 * beside) {
    for (const std::uint32_t i : a.voxels) {
        if (b.rectangle.distance(all.voxels[i].place.head<2>()) <= gap) return true;
    }
    return false;
}

/// The inside of a drawer that stands open: partly under a top, with nothing below the part that
/// is not.
bool is_drawer_of(const FurnitureVoxels& all, const LevelSlab& slab, const LevelSlab& top,
                  double share) {
    if (use_of(top) != SlabUse::table || slab.height > top.height || share < 0.25) return false;
    constexpr double low = 0.25;
    constexpr std::size_t few = 8;
    std::size_t below = 0;
    for (const FurnitureVoxel& voxel : all.voxels) {
        if (!voxel.is_core || voxel.height > low) continue;
        const Eigen::Vector2d place = voxel.place.head<2>();
        below += slab.rectangle.distance(place) <= beside && top.rectangle.distance(place) > beside
                     ? 1U
                     : 0U;
    }
    return below < few;
}

bool are_in_one_room(const FurnitureVoxels& all, const LevelSlab& a, const LevelSlab& b) {
    const FurnitureVoxel& of_a = all.voxels[a.voxels.front()];
    const FurnitureVoxel& of_b = all.voxels[b.voxels.front()];
    return of_a.storey == of_b.storey && of_a.room == of_b.room;
}

/// Cushions, arms and backs of one sofa, mattress and pillows of one bed: low, side by side, they
/// fill a rectangle of its size, which is closed below.
class UpholsteryTest {
  public:
    explicit UpholsteryTest(const FurnitureVoxels& all) : all_(all) {}

    bool operator()(const LevelSlab& a, const LevelSlab& b) const {
        if (!may_be_part(a) || !may_be_part(b)) return false;
        if (std::min(a.height, b.height) > max_low || !touch(all_, a, b)) return false;
        if (are_two_chairs(a, b)) return false;
        std::vector<Eigen::Vector2d> places;
        for (const LevelSlab* slab : {&a, &b}) {
            for (const std::uint32_t i : slab->voxels)
                places.emplace_back(all_.voxels[i].place.head<2>());
        }
        const PlanRectangle both = smallest_rectangle(places);
        const bool is_sofa = both.length <= 2.6 && both.width <= 1.15;
        const bool is_bed = both.length <= 2.4 && both.width <= 2.2;
        const bool fills = a.area + b.area >= 0.7 * both.area() && !has_gap(places, both);
        return (is_sofa || is_bed) && fills && is_closed_below(both, a);
    }

    /// Whether all of a cluster is one such piece.
    bool is_one_piece(std::span<const std::uint32_t> cluster, std::span<const LevelSlab> slabs,
                      const std::vector<std::size_t>& slab_of_voxel) const {
        std::vector<Eigen::Vector2d> places;
        double top = 0.0;
        const LevelSlab* largest = nullptr;
        for (const std::uint32_t i : cluster) {
            places.emplace_back(all_.voxels[i].place.head<2>());
            top = std::max(top, all_.voxels[i].height);
            if (slab_of_voxel[i] == none) continue;
            const LevelSlab& slab = slabs[slab_of_voxel[i]];
            if (!may_be_part(slab)) return false;
            if (!largest || slab.area > largest->area) largest = &slab;
            if (&slab == largest) continue;
            if (are_two_chairs(slab, *largest)) return false;
        }
        if (!largest || top > 1.25 || largest->height > max_low) return false;
        const PlanRectangle whole = smallest_rectangle(places);
        const bool is_sofa = whole.length <= 2.6 && whole.width <= 1.2 && whole.width >= 0.6;
        const bool is_bed = whole.length <= 2.5 && whole.length >= 1.8 && whole.width <= 2.3;
        constexpr double min_fill = 0.8;
        if (filled_area(cluster) < min_fill * whole.area()) return false;
        constexpr double cushion_step = 0.06;  // m
        std::vector<Eigen::Vector2d> seat;
        for (const std::uint32_t i : cluster) {
            if (all_.voxels[i].is_level &&
                std::abs(all_.voxels[i].height - largest->height) <= cushion_step)
                seat.emplace_back(all_.voxels[i].place.head<2>());
        }
        if (has_gap(seat, whole)) return false;
        return (is_sofa || is_bed) && is_closed_below(whole, *largest);
    }

  private:
    /// Seats of one height with a gap between: cushions of a sofa touch.
    bool are_two_chairs(const LevelSlab& a, const LevelSlab& b) const {
        constexpr double min_gap = 0.07;
        return use_of(a) == SlabUse::seat && use_of(b) == SlabUse::seat &&
               !touch(all_, a, b, min_gap);
    }

    /// Whether seats leave a gap between them along a rectangle, as chairs in a row do.
    bool has_gap(std::span<const Eigen::Vector2d> places, const PlanRectangle& rectangle) const {
        constexpr std::size_t few = 3;  // voxels of a seat's depth
        std::vector<std::size_t> count(static_cast<std::size_t>(rectangle.length / all_.reach) + 1,
                                       0);
        for (const Eigen::Vector2d& place : places) {
            const double along =
                (place - rectangle.center).dot(rectangle.axis) + 0.5 * rectangle.length;
            ++count[std::min(static_cast<std::size_t>(std::max(along, 0.0) / all_.reach),
                             count.size() - 1)];
        }
        const auto is_filled = [](std::size_t n) { return n >= few; };
        const auto first = std::find_if(count.begin(), count.end(), is_filled);
        const auto last = std::find_if(count.rbegin(), count.rend(), is_filled).base();
        return first < last && !std::all_of(first, last, is_filled);
    }

    /// A top at a table's height that is wider than a back or an arm is none.
    static bool may_be_part(const LevelSlab& slab) {
        return slab.height <= max_low || (slab.height <= 1.1 && slab.rectangle.width <= 0.36);
    }

    /// m2, of the plan, in squares of two voxels.
    double filled_area(std::span<const std::uint32_t> cluster) const {
        std::vector<std::pair<std::int32_t, std::int32_t>> cells;
        for (const std::uint32_t i : cluster) {
            const Eigen::Vector3d& place = all_.voxels[i].place;
            cells.emplace_back(static_cast<std::int32_t>(std::floor(place.x() / all_.reach)),
                               static_cast<std::int32_t>(std::floor(place.y() / all_.reach)));
        }
        std::sort(cells.begin(), cells.end());
        const auto count = std::unique(cells.begin(), cells.end()) - cells.begin();
        return all_.reach * all_.reach * static_cast<double>(count);
    }

    bool is_closed_below(const PlanRectangle& rectangle, const LevelSlab& some) const {
        // Two sides were seen, five voxels high.
        constexpr double low = 0.12;
        constexpr double high = 0.32;
        constexpr double min_share = 0.35;
        std::size_t count = 0;
        for (const FurnitureVoxel& voxel : all_.voxels) {
            if (voxel.room != all_.voxels[some.voxels.front()].room) continue;
            if (voxel.height < low || voxel.height > high) continue;
            // Legs close nothing.
            if (!voxel.is_upright || !voxel.is_planar) continue;
            count += rectangle.distance(voxel.place.head<2>()) <= beside ? 1U : 0U;
        }
        const double cell = all_.reach / 2.0;
        const double expected = (rectangle.length + rectangle.width) * (high - low) / (cell * cell);
        return static_cast<double>(count) >= min_share * expected;
    }

    const FurnitureVoxels& all_;
};

/// Slabs that are parts of others, and slabs that are one piece.
struct SlabGroups {
    std::vector<std::size_t> group_of_slab;         ///< none for a part or a thing on another
    std::vector<std::vector<std::size_t>> members;  ///< the largest first
};

SlabGroups group_slabs(const FurnitureVoxels& all, std::span<const LevelSlab> slabs) {
    const std::size_t count = slabs.size();
    DisjointSets sets(count);
    const UpholsteryTest is_upholstery(all);
    std::vector<bool> is_part(count, false);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 1; j < count; ++j) {
            // The larger first.
            const LevelSlab& large = slabs[i];
            const LevelSlab& small = slabs[j];
            if (!are_in_one_room(all, large, small)) continue;
            const double reach = 0.5 * (std::hypot(large.rectangle.length, large.rectangle.width) +
                                        std::hypot(small.rectangle.length, small.rectangle.width));
            if ((large.rectangle.center - small.rectangle.center).norm() > reach + 0.2) continue;
            const double of_small = share_within(all, small, large.rectangle, beside);
            const double of_large = share_within(all, large, small.rectangle, beside);
            const bool is_seat_below = use_of(small) == SlabUse::seat &&
                                       use_of(large) == SlabUse::table &&
                                       large.height - small.height > 0.12;
            const bool is_board = are_boards(small, large, of_small, of_large) && !is_seat_below;
            const bool is_on_or_in = (is_lying_over(of_small) && !is_seat_below) ||
                                     is_drawer_of(all, small, large, of_small);
            if (!is_board && is_on_or_in) {
                is_part[j] = true;
            } else if (is_board || is_upholstery(large, small) ||
                       (touch(all, small, large) &&
                        (is_rail_of(small, large) || is_rail_of(large, small)))) {
                sets.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
            }
        }
    }
    SlabGroups groups;
    groups.group_of_slab.assign(count, none);
    std::vector<std::size_t> group_of_set(count, none);
    for (std::size_t i = 0; i < count; ++i) {
        if (is_part[i]) continue;
        std::size_t& group = group_of_set[sets.find(static_cast<std::uint32_t>(i))];
        if (group == none) {
            group = groups.members.size();
            groups.members.emplace_back();
        }
        groups.group_of_slab[i] = group;
        groups.members[group].push_back(i);
    }
    return groups;
}

/// Which group a voxel goes to, and whether it stands on one.
class Claims {
  public:
    Claims(std::span<const LevelSlab> slabs, const SlabGroups& groups)
        : slabs_(slabs), groups_(groups) {}

    /// The cost at which a slab claims a voxel; infinite if it does not.
    double cost(std::size_t number, const FurnitureVoxel& voxel) const {
        constexpr double no = std::numeric_limits<double>::infinity();
        constexpr double outside_weight = 4.0;
        const LevelSlab& slab = slabs_[number];
        const SlabUse use = use_of(slab);
        const double outside = slab.rectangle.distance(voxel.place.head<2>());
        if (outside > (use == SlabUse::seat ? beside_seat : beside)) return no;
        const double above = voxel.height - slab.height;
        const double away = outside_weight * std::max(outside, 0.0);
        // The underside of what hangs on a wall.
        if (use == SlabUse::high && slab.looks_down) {
            const bool is_of_box = above >= -0.03 - voxel.noise && above <= max_unit_height;
            return is_of_box ? std::max(above, 0.0) + away : no;
        }
        if (above <= 0.03 + voxel.noise) return std::max(-above, 0.0) + away;
        if (use == SlabUse::seat && above <= back_height) return 0.5 * above + away;
        if (use == SlabUse::low && above <= back_height) return above + away;
        return no;
    }

    std::size_t group_of(const FurnitureVoxel& voxel, std::span<const std::size_t> groups) const {
        std::size_t best = none;
        double least = std::numeric_limits<double>::infinity();
        for (const std::size_t group : groups) {
            for (const std::size_t slab : groups_.members[group]) {
                const double cost_here = cost(slab, voxel);
                if (cost_here >= least) continue;
                least = cost_here;
                best = group;
            }
        }
        return best;
    }

    /// Whether a voxel lies within the rectangle of one of a group's slabs.
    bool holds(std::size_t group, const FurnitureVoxel& voxel) const {
        const std::vector<std::size_t>& members = groups_.members[group];
        return std::any_of(members.begin(), members.end(), [&](std::size_t slab) {
            return slabs_[slab].rectangle.distance(voxel.place.head<2>()) <= 0.0;
        });
    }

    /// Near a group that is no lower than `top`.
    bool is_beside(const FurnitureVoxel& voxel, double top,
                   std::span<const std::size_t> groups) const {
        constexpr double near = 0.15;
        for (const std::size_t group : groups) {
            for (const std::size_t slab : groups_.members[group]) {
                if (slabs_[slab].height + 0.1 >= top &&
                    slabs_[slab].rectangle.distance(voxel.place.head<2>()) <= near) {
                    return true;
                }
            }
        }
        return false;
    }

    bool stands_on(const FurnitureVoxel& voxel, std::span<const std::size_t> groups) const {
        for (const std::size_t group : groups) {
            for (const std::size_t slab : groups_.members[group]) {
                if (voxel.height > slabs_[slab].height &&
                    slabs_[slab].rectangle.distance(voxel.place.head<2>()) <= -0.03) {
                    return true;
                }
            }
        }
        return false;
    }

  private:
    std::span<const LevelSlab> slabs_;
    const SlabGroups& groups_;
};

/// Components of core voxels; those that share a group's slabs are one.
std::vector<std::vector<std::uint32_t>> find_clusters(const FurnitureVoxels& all,
                                                      std::span<const LevelSlab> slabs,
                                                      const SlabGroups& groups) {
    std::vector<bool> is_core(all.voxels.size());
    std::vector<std::uint32_t> core;
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        is_core[i] = all.voxels[i].is_core;
        if (is_core[i]) core.push_back(i);
    }
    std::vector<std::vector<std::uint32_t>> sets = connected_voxels(all, core, is_core);
    std::vector<std::uint32_t> set_of_voxel(all.voxels.size(), 0);
    for (std::uint32_t s = 0; s < sets.size(); ++s) {
        for (const std::uint32_t i : sets[s])
            set_of_voxel[i] = s;
    }
    DisjointSets joined(sets.size());
    for (const std::vector<std::size_t>& members : groups.members) {
        const std::uint32_t first = set_of_voxel[slabs[members.front()].voxels.front()];
        for (const std::size_t slab : members) {
            for (const std::uint32_t i : slabs[slab].voxels)
                joined.join(first, set_of_voxel[i]);
        }
    }
    std::vector<std::vector<std::uint32_t>> clusters(sets.size());
    for (std::uint32_t s = 0; s < sets.size(); ++s) {
        std::vector<std::uint32_t>& cluster = clusters[joined.find(s)];
        cluster.insert(cluster.end(), sets[s].begin(), sets[s].end());
    }
    for (std::vector<std::uint32_t>& cluster : clusters)
        std::sort(cluster.begin(), cluster.end());
    return clusters;
}

/// What was seen so sparsely that it hangs together with nothing goes to the slab that claims it
/// within its rectangle: far from a scanner its rays are farther apart than voxels reach.
void claim_strays(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                  const SlabGroups& groups, const Claims& claims,
                  std::vector<std::size_t>& group_of_voxel) {
    using Room = std::pair<std::uint32_t, std::int32_t>;
    std::vector<bool> is_drafted(groups.members.size(), false);
    for (const std::size_t group : group_of_voxel) {
        if (group != none) is_drafted[group] = true;
    }
    std::map<Room, std::vector<std::size_t>> groups_of_room;
    for (std::size_t group = 0; group < groups.members.size(); ++group) {
        if (!is_drafted[group]) continue;
        const LevelSlab& slab = slabs[groups.members[group].front()];
        const FurnitureVoxel& some = all.voxels[slab.voxels.front()];
        groups_of_room[{some.storey, some.room}].push_back(group);
    }
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (!voxel.is_stray || group_of_voxel[i] != none) continue;
        const auto here = groups_of_room.find({voxel.storey, voxel.room});
        if (here == groups_of_room.end()) continue;
        const std::size_t group = claims.group_of(voxel, here->second);
        if (group != none && claims.holds(group, voxel)) group_of_voxel[i] = group;
    }
}

/// Sides, open doors and drawers' fronts: thin, beside a piece and no taller.
bool is_panel_of(const FurnitureVoxels& all, std::span<const std::uint32_t> rest,
                 const PlanRectangle& rectangle, double top, std::span<const std::size_t> groups,
                 const Claims& claims) {
    constexpr double max_thickness = 0.2;
    if (rectangle.width > max_thickness) return false;
    std::size_t near = 0;
    for (const std::uint32_t i : rest)
        near += claims.is_beside(all.voxels[i], top, groups) ? 1U : 0U;
    return 10 * near >= 7 * rest.size();
}

/// What no slab claims of a cluster: things on tops are dropped, crumbs go to the piece that they
/// touch, the rest are things of their own.
void draft_rest(const FurnitureVoxels& all, std::span<const std::uint32_t> cluster,
                std::vector<bool>& is_rest, std::span<const std::size_t> groups,
                const Claims& claims, std::vector<std::size_t>& group_of_voxel,
                std::vector<PieceDraft>& drafts) {
    for (std::vector<std::uint32_t>& rest : connected_voxels(all, cluster, is_rest)) {
        std::size_t on_top = 0;
        double low = std::numeric_limits<double>::infinity();
        double high = 0.0;
        for (const std::uint32_t i : rest) {
            on_top += claims.stands_on(all.voxels[i], groups) ? 1U : 0U;
            low = std::min(low, all.voxels[i].height);
            high = std::max(high, all.voxels[i].height);
        }
        if (10 * on_top >= 7 * rest.size()) continue;
        const PlanRectangle rectangle = smallest_rectangle(places_of(all, rest));
        const bool is_crumb = rest.size() < 3 * min_voxels || high - low < 0.3 ||
                              (rectangle.length < 0.25 && high < 0.8) ||
                              is_panel_of(all, rest, rectangle, high, groups, claims);
        if (!is_crumb) {
            drafts.push_back({std::move(rest), {}});
            continue;
        }
        std::vector<std::size_t> votes;
        for (const std::uint32_t i : rest) {
            for (const std::uint32_t next : all.neighbors_of(i)) {
                if (group_of_voxel[next] != none) votes.push_back(group_of_voxel[next]);
            }
        }
        if (votes.empty()) continue;
        std::sort(votes.begin(), votes.end());
        const std::size_t group = votes[votes.size() / 2];
        for (const std::uint32_t i : rest)
            group_of_voxel[i] = group;
    }
}

/// Backs lean out behind a seat; what has none ends with its seat, and what lies farther out is of
/// the wall or floor beside, where rays met both.
void drop_beside_stools(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                        const SlabGroups& groups, std::vector<std::size_t>& group_of_voxel) {
    constexpr double max_rise = 0.14;  // m: backs are higher
    constexpr double few = 0.05;       // of the voxels
    std::vector<std::size_t> count(groups.members.size(), 0);
    std::vector<std::size_t> above(groups.members.size(), 0);
    const auto seat_of = [&](std::size_t group) -> const LevelSlab& {
        return slabs[groups.members[group].front()];
    };
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        const std::size_t group = group_of_voxel[i];
        if (group == none) continue;
        ++count[group];
        const FurnitureVoxel& voxel = all.voxels[i];
        above[group] += voxel.height > seat_of(group).height + max_rise + voxel.noise ? 1U : 0U;
    }
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        const std::size_t group = group_of_voxel[i];
        if (group == none || use_of(seat_of(group)) != SlabUse::seat) continue;
        const bool has_back =
            static_cast<double>(above[group]) > few * static_cast<double>(count[group]);
        const double outside = seat_of(group).rectangle.distance(all.voxels[i].place.head<2>());
        if (!has_back && groups.members[group].size() == 1 && outside > beside)
            group_of_voxel[i] = none;
    }
}

}  // namespace

SlabUse use_of(const LevelSlab& slab) {
    if (slab.height >= min_seat && slab.height <= max_seat &&
        slab.rectangle.length <= max_seat_width) {
        return SlabUse::seat;
    }
    if (slab.height <= max_low) return SlabUse::low;
    return slab.height <= max_table ? SlabUse::table : SlabUse::high;
}

std::vector<PieceDraft> draft_pieces(const FurnitureVoxels& all, std::span<const LevelSlab> slabs) {
    const SlabGroups groups = group_slabs(all, slabs);
    const Claims claims(slabs, groups);
    std::vector<std::size_t> group_of_voxel(all.voxels.size(), none);
    std::vector<std::size_t> slab_of_voxel(all.voxels.size(), none);
    for (std::size_t slab = 0; slab < slabs.size(); ++slab) {
        for (const std::uint32_t i : slabs[slab].voxels) {
            group_of_voxel[i] = groups.group_of_slab[slab];
            slab_of_voxel[i] = slab;
        }
    }
    const UpholsteryTest is_upholstery(all);
    std::vector<PieceDraft> whole;
    std::vector<PieceDraft> rests;
    std::vector<bool> is_rest(all.voxels.size(), false);
    for (const std::vector<std::uint32_t>& cluster : find_clusters(all, slabs, groups)) {
        if (cluster.size() < min_voxels) continue;
        if (is_upholstery.is_one_piece(cluster, slabs, slab_of_voxel)) {
            whole.push_back({cluster, {}});
            for (const std::uint32_t i : cluster) {
                const std::size_t slab = slab_of_voxel[i];
                std::vector<std::size_t>& known = whole.back().slabs;
                if (slab != none && std::find(known.begin(), known.end(), slab) == known.end())
                    known.push_back(slab);
                group_of_voxel[i] = none;
            }
            std::sort(whole.back().slabs.begin(), whole.back().slabs.end());
            continue;
        }
        std::vector<std::size_t> present;
        for (const std::uint32_t i : cluster) {
            if (group_of_voxel[i] != none) present.push_back(group_of_voxel[i]);
        }
        std::sort(present.begin(), present.end());
        present.erase(std::unique(present.begin(), present.end()), present.end());
        for (const std::uint32_t i : cluster) {
            if (group_of_voxel[i] != none) continue;
            group_of_voxel[i] = claims.group_of(all.voxels[i], present);
            is_rest[i] = group_of_voxel[i] == none;
        }
        draft_rest(all, cluster, is_rest, present, claims, group_of_voxel, rests);
    }
    claim_strays(all, slabs, groups, claims, group_of_voxel);
    drop_beside_stools(all, slabs, groups, group_of_voxel);
    std::vector<PieceDraft> drafts(groups.members.size());
    for (std::size_t group = 0; group < drafts.size(); ++group)
        drafts[group].slabs = groups.members[group];
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        if (group_of_voxel[i] != none) drafts[group_of_voxel[i]].voxels.push_back(i);
    }
    std::move(whole.begin(), whole.end(), std::back_inserter(drafts));
    for (const PieceDraft& rest : rests) {
        for (std::vector<std::uint32_t>& part : cut_row(all, rest.voxels))
            drafts.push_back({std::move(part), {}});
    }
    return drafts;
}

}  // namespace roomscribe
