// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/chair_backs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t no_draft = std::numeric_limits<std::size_t>::max();
/// m. Backs are 0.35 to 0.5 wide and end 0.75 to 1.1 above the floor.
constexpr double min_width = 0.30;
constexpr double max_width = 0.56;
constexpr double min_bottom = 0.38;
constexpr double min_top = 0.72;
constexpr double max_top = 1.15;
constexpr double min_height = 0.12;
/// Voxels of 4 cm: the lowest rail of a back is 0.4 x 0.15 m.
constexpr std::size_t min_voxels = 35;
/// m: chairs are so deep before their back, which leans out behind its legs.
constexpr double seat_depth = 0.5;
constexpr double lean = 0.1;
/// Voxels of 4 cm, of a seat or of legs: two legs to half their height.
constexpr std::size_t enough_below = 15;
/// m: seats and legs are a little wider than the back.
constexpr double beside = 0.05;

/// m, the part of a back's axis between which it lies.
std::pair<double, double> span_along(const ChairBack& back, const Eigen::Vector2d& axis) {
    const double middle = back.rectangle.center.dot(axis);
    const double half = 0.5 * back.rectangle.length * std::abs(back.rectangle.axis.dot(axis));
    return {middle - half, middle + half};
}

/// Whether noise parted one back: two layers of it, one before the other.
bool are_one_back(const ChairBack& a, const ChairBack& b) {
    constexpr double max_step = 0.12;  // m
    const Eigen::Vector2d offset = b.rectangle.center - a.rectangle.center;
    if (std::abs(offset.dot(a.rectangle.across())) > max_step) return false;
    const auto [a_low, a_high] = span_along(a, a.rectangle.axis);
    const auto [b_low, b_high] = span_along(b, a.rectangle.axis);
    const double shared = std::min(a_high, b_high) - std::max(a_low, b_low);
    return shared >= 0.5 * std::min(a_high - a_low, b_high - b_low);
}

/// A patch's voxels as a back, if they have its size. Hind legs may lie in its plane.
bool is_back(const FurnitureVoxels& all, ChairBack& back) {
    constexpr double strays = 0.03;
    constexpr double min_fill = 0.5;
    constexpr double max_legs = 0.3;  // of the voxels
    const auto num_all = static_cast<double>(back.voxels.size());
    std::erase_if(back.voxels, [&](std::uint32_t i) { return all.voxels[i].height < min_bottom; });
    const auto count = static_cast<double>(back.voxels.size());
    if (back.voxels.size() < min_voxels || num_all - count > max_legs * num_all) return false;
    std::vector<double> heights;
    for (const std::uint32_t i : back.voxels)
        heights.push_back(all.voxels[i].height);
    back.bottom = quantile(heights, strays);
    back.top = quantile(heights, 1.0 - strays);
    if (back.top < min_top || back.top > max_top || back.top - back.bottom < min_height)
        return false;
    back.rectangle = smallest_rectangle(places_of(all, back.voxels));
    if (back.rectangle.length < min_width || back.rectangle.length > max_width) return false;
    const double area = 0.25 * all.reach * all.reach * count;
    return area >= min_fill * back.rectangle.length * (back.top - back.bottom);
}

bool is_of(std::span<const std::uint32_t> patches, std::uint32_t patch) {
    return std::find(patches.begin(), patches.end(), patch) != patches.end();
}

class ChairParter {
  public:
    ChairParter(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                std::vector<PieceDraft>& drafts)
        : all_(all), slabs_(slabs), drafts_(drafts), draft_of_voxel_(all.voxels.size(), no_draft) {
        for (std::size_t d = 0; d < drafts.size(); ++d) {
            for (const std::uint32_t i : drafts[d].voxels)
                draft_of_voxel_[i] = d;
        }
    }

    void part(const std::vector<ChairBack>& backs) {
        std::map<std::size_t, std::vector<const ChairBack*>> backs_of_draft;
        for (const ChairBack& back : backs)
            backs_of_draft[owner_of(back)].push_back(&back);
        for (const auto& [draft, of_draft] : backs_of_draft) {
            if (draft == no_draft || is_below_some(draft, of_draft)) {
                for (const ChairBack* back : of_draft) {
                    if (draft != no_draft && !rises_beyond(*back, top_of(draft))) continue;
                    if (stands_on_something(*back)) take(*back);
                }
            } else if (of_draft.size() > 1) {
                part(draft, of_draft);
            }
        }
    }

  private:
    /// The draft that has most of a back.
    std::size_t owner_of(const ChairBack& back) const {
        std::map<std::size_t, std::size_t> votes;
        for (const std::uint32_t i : back.voxels)
            ++votes[draft_of_voxel_[i]];
        return std::max_element(votes.begin(), votes.end(),
                                [](const auto& a, const auto& b) { return a.second < b.second; })
            ->first;
    }

    /// m above the floor, of a table's top; 0 for other drafts.
    double top_of(std::size_t draft) const {
        if (drafts_[draft].slabs.empty()) return 0.0;
        const LevelSlab& slab = slabs_[drafts_[draft].slabs.front()];
        return use_of(slab) == SlabUse::table ? slab.height : 0.0;
    }

    static bool rises_beyond(const ChairBack& back, double top) {
        constexpr double rise = 0.05;  // m
        return back.bottom <= top - rise && back.top >= top + rise;
    }

    bool is_below_some(std::size_t draft, const std::vector<const ChairBack*>& backs) const {
        const double top = top_of(draft);
        return top > 0.0 && std::any_of(backs.begin(), backs.end(), [&](const ChairBack* back) {
                   return rises_beyond(*back, top);
               });
    }

    /// Whether something of a seat or of legs was seen below a back or before it.
    bool stands_on_something(const ChairBack& back) const {
        const FurnitureVoxel& some = all_.voxels[back.voxels.front()];
        std::array<std::size_t, 2> counts{};
        for (const FurnitureVoxel& voxel : all_.voxels) {
            if (voxel.storey != some.storey || voxel.room != some.room || voxel.is_near_wall ||
                voxel.height > max_seat || is_of(back.patches, voxel.patch))
                continue;
            const Eigen::Vector2d place = voxel.place.head<2>();
            for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
                const Eigen::Vector2d across = back.rectangle.across();
                const ChairPlace chair{back.rectangle, side == 0 ? across : -across};
                counts[side] += chair.holds(place) ? 1U : 0U;
            }
        }
        return std::max(counts[0], counts[1]) >= enough_below;
    }

    /// Makes a draft of a back.
    void take(const ChairBack& back) {
        for (const std::uint32_t i : back.voxels) {
            if (draft_of_voxel_[i] != no_draft) std::erase(drafts_[draft_of_voxel_[i]].voxels, i);
            draft_of_voxel_[i] = drafts_.size();
        }
        drafts_.push_back({back.voxels, {}});
    }

    /// To which side of its back the rest of a draft's chair is.
    ChairPlace place_of(const PieceDraft& draft, const ChairBack& back) const {
        std::array<ChairPlace, 2> sides{{{back.rectangle, back.rectangle.across()},
                                         {back.rectangle, -back.rectangle.across()}}};
        std::array<std::size_t, 2> counts{};
        for (const std::uint32_t i : draft.voxels) {
            if (all_.voxels[i].height > max_seat) continue;
            for (std::size_t side = 0; side < 2; ++side)
                counts[side] += sides[side].holds(all_.voxels[i].place.head<2>()) ? 1U : 0U;
        }
        return counts[0] >= counts[1] ? sides[0] : sides[1];
    }

    std::ptrdiff_t count_low(const PieceDraft& draft) const {
        return std::count_if(draft.voxels.begin(), draft.voxels.end(),
                             [&](std::uint32_t i) { return all_.voxels[i].height <= max_seat; });
    }

    bool has_seat_or_legs(const PieceDraft& chair, const ChairBack& back) const {
        const auto low = std::count_if(chair.voxels.begin(), chair.voxels.end(), [&](auto i) {
            const FurnitureVoxel& voxel = all_.voxels[i];
            return voxel.height <= max_seat && !is_of(back.patches, voxel.patch);
        });
        return static_cast<std::size_t>(low) >= enough_below;
    }

    void part(std::size_t number, const std::vector<const ChairBack*>& backs) {
        constexpr double max_left = 0.35;  // of what is low: sofas are deeper than chairs
        const PieceDraft draft = drafts_[number];
        if (draft.is_chair || draft.is_under_top || top_of(number) > 0.0) return;
        const bool is_tall =
            std::any_of(draft.voxels.begin(), draft.voxels.end(),
                        [&](std::uint32_t i) { return all_.voxels[i].height > max_top + 0.1; });
        if (is_tall) return;
        std::vector<ChairPlace> places;
        places.reserve(backs.size());
        for (const ChairBack* back : backs)
            places.push_back(place_of(draft, *back));
        std::vector<PieceDraft> chairs(backs.size());
        PieceDraft rest{{}, draft.slabs};
        for (const std::uint32_t i : draft.voxels) {
            const Eigen::Vector2d place = all_.voxels[i].place.head<2>();
            std::size_t best = no_draft;
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t c = 0; c < places.size(); ++c) {
                if (!places[c].holds(place)) continue;
                const PlanRectangle& back = places[c].back;
                const double away = std::abs((place - back.center).dot(back.axis)) / back.length;
                if (away >= least) continue;
                least = away;
                best = c;
            }
            (best == no_draft ? rest : chairs[best]).voxels.push_back(i);
        }
        if (static_cast<double>(count_low(rest)) > max_left * static_cast<double>(count_low(draft)))
            return;
        for (std::size_t c = 0; c < chairs.size(); ++c) {
            if (!has_seat_or_legs(chairs[c], *backs[c]) ||
                is_closed_below(all_, chairs[c].voxels, backs[c]->patches,
                                backs[c]->rectangle.length))
                return;
            for (std::size_t other = 0; other < c; ++other) {
                if (places[c].holds(places[other].back.center) ||
                    places[other].holds(places[c].back.center))
                    return;
            }
        }
        drafts_[number] = std::move(rest);
        drafts_[number].slabs.clear();
        for (PieceDraft& chair : chairs) {
            chair.is_chair = true;
            drafts_.push_back(std::move(chair));
        }
    }

    const FurnitureVoxels& all_;
    std::span<const LevelSlab> slabs_;
    std::vector<PieceDraft>& drafts_;
    std::vector<std::size_t> draft_of_voxel_;
};

}  // namespace

bool ChairPlace::holds(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d from = place - back.center;
    const double before = from.dot(forward);
    return std::abs(from.dot(back.axis)) <= 0.5 * back.length + beside &&
           before >= -0.5 * back.width - lean && before <= seat_depth;
}

bool is_closed_below(const FurnitureVoxels& all, std::span<const std::uint32_t> below,
                     std::span<const std::uint32_t> back_patches, double width) {
    constexpr double min_closed = 0.5;
    std::map<std::uint32_t, std::size_t> count_of_patch;
    std::size_t most = 0;
    for (const std::uint32_t i : below) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (voxel.height > min_bottom || !voxel.is_upright || !voxel.is_planar) continue;
        if (is_of(back_patches, voxel.patch)) continue;
        most = std::max(most, ++count_of_patch[voxel.patch]);
    }
    const double voxel_area = 0.25 * all.reach * all.reach;
    return voxel_area * static_cast<double>(most) >= min_closed * width * min_bottom;
}

std::vector<ChairBack> find_chair_backs(const FurnitureVoxels& all) {
    std::map<std::tuple<std::uint32_t, std::int32_t, std::uint32_t>, ChairBack> patches;
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (voxel.patch == off_patch || !voxel.is_upright || !voxel.is_planar) continue;
        patches[{voxel.storey, voxel.room, voxel.patch}].voxels.push_back(i);
    }
    std::vector<ChairBack> backs;
    for (auto& entry : patches) {
        ChairBack& back = entry.second;
        back.patches = {std::get<2>(entry.first)};
        const auto near_wall =
            std::count_if(back.voxels.begin(), back.voxels.end(),
                          [&](std::uint32_t i) { return all.voxels[i].is_near_wall; });
        if (2 * static_cast<std::size_t>(near_wall) > back.voxels.size() || !is_back(all, back))
            continue;
        const FurnitureVoxel& some = all.voxels[back.voxels.front()];
        const auto same = std::find_if(backs.begin(), backs.end(), [&](const ChairBack& known) {
            const FurnitureVoxel& other = all.voxels[known.voxels.front()];
            return other.storey == some.storey && other.room == some.room &&
                   are_one_back(known, back);
        });
        if (same == backs.end()) {
            backs.push_back(std::move(back));
            continue;
        }
        same->patches.insert(same->patches.end(), back.patches.begin(), back.patches.end());
        same->voxels.insert(same->voxels.end(), back.voxels.begin(), back.voxels.end());
        std::sort(same->voxels.begin(), same->voxels.end());
    }
    return backs;
}

void part_chairs(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                 std::vector<PieceDraft>& drafts) {
    ChairParter(all, slabs, drafts).part(find_chair_backs(all));
}

}  // namespace roomscribe
