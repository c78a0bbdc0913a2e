// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/hidden_seats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "roomscribe/interpretation/furniture/chair_backs.hpp"
#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"
#include "roomscribe/interpretation/furniture/piece_form.hpp"
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t no_draft = std::numeric_limits<std::size_t>::max();
/// m above the floor: what ends lower has no back of its own.
constexpr double min_back_top = 0.75;

class ChairCompleter {
  public:
    ChairCompleter(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                   std::vector<PieceDraft>& drafts)
        : all_(all),
          slabs_(slabs),
          drafts_(drafts),
          draft_of_voxel_(all.voxels.size(), no_draft),
          top_(drafts.size(), 0.0) {
        for (std::size_t d = 0; d < drafts.size(); ++d) {
            for (const std::uint32_t i : drafts[d].voxels) {
                draft_of_voxel_[i] = d;
                top_[d] = std::max(top_[d], all.voxels[i].height);
            }
        }
    }

    void complete(std::size_t back, const PlanRectangle& rectangle) {
        std::array<std::vector<std::uint32_t>, 2> sides;
        for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
            const Eigen::Vector2d across = rectangle.across();
            sides[side] = find_below(back, {rectangle, side == 0 ? across : -across});
        }
        const std::vector<std::uint32_t>& below =
            sides[0].size() >= sides[1].size() ? sides[0] : sides[1];
        if (is_closed_below(all_, below, {}, rectangle.length)) return;
        PieceDraft& draft = drafts_[back];
        draft.is_chair = true;
        for (const std::uint32_t i : below) {
            if (draft_of_voxel_[i] != no_draft) std::erase(drafts_[draft_of_voxel_[i]].voxels, i);
            draft_of_voxel_[i] = back;
            draft.voxels.push_back(i);
        }
        std::sort(draft.voxels.begin(), draft.voxels.end());
    }

  private:
    /// What of a chair lies in a place below its back.
    std::vector<std::uint32_t> find_below(std::size_t back, const ChairPlace& chair) const {
        const FurnitureVoxel& some = all_.voxels[drafts_[back].voxels.front()];
        std::vector<std::uint32_t> found;
        for (std::uint32_t i = 0; i < all_.voxels.size(); ++i) {
            const FurnitureVoxel& voxel = all_.voxels[i];
            if (voxel.storey != some.storey || voxel.room != some.room) continue;
            if (voxel.is_near_wall || !chair.holds(voxel.place.head<2>())) continue;
            if (may_give(draft_of_voxel_[i], voxel, chair)) found.push_back(i);
        }
        return found;
    }

    /// Whether a voxel may be a chair's though a draft has it.
    bool may_give(std::size_t draft, const FurnitureVoxel& voxel, const ChairPlace& chair) const {
        const bool is_low = voxel.height <= max_seat;
        if (draft == no_draft) return is_low;
        const PieceDraft& owner = drafts_[draft];
        if (owner.is_chair || owner.is_under_top) return false;
        if (owner.slabs.empty()) return is_low && top_[draft] < min_back_top;
        const LevelSlab& slab = slabs_[owner.slabs.front()];
        // Seats beside are of other chairs; arms rise above their own.
        if (use_of(slab) == SlabUse::seat)
            return slab.rectangle.length <= max_seat_width && chair.holds(slab.rectangle.center);
        return use_of(slab) == SlabUse::table && is_low && !carries_top(draft, slab, voxel);
    }

    /// Legs and panels go on above a seat's height up to the top.
    bool carries_top(std::size_t draft, const LevelSlab& top, const FurnitureVoxel& voxel) const {
        constexpr double below_top = 0.05;  // m: plates are 18 to 40 mm thick
        const std::vector<std::uint32_t>& voxels = drafts_[draft].voxels;
        return std::any_of(voxels.begin(), voxels.end(), [&](std::uint32_t i) {
            const FurnitureVoxel& other = all_.voxels[i];
            return other.height > max_seat && other.height < top.height - below_top &&
                   (other.place - voxel.place).head<2>().norm() <= 0.5 * all_.reach;
        });
    }

    const FurnitureVoxels& all_;
    std::span<const LevelSlab> slabs_;
    std::vector<PieceDraft>& drafts_;
    std::vector<std::size_t> draft_of_voxel_;
    std::vector<double> top_;  ///< m above the floor, of each draft
};

}  // namespace

void complete_chairs(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                     const RoomSurfaces& surfaces, std::vector<PieceDraft>& drafts) {
    ChairCompleter chairs(all, slabs, drafts);
    for (std::size_t d = 0; d < drafts.size(); ++d) {
        if (drafts[d].voxels.empty() || !drafts[d].slabs.empty()) continue;
        const PieceForm form = measure_form(all, slabs, drafts[d], surfaces);
        if (is_back_of_chair(form)) chairs.complete(d, form.rectangle);
    }
}

}  // namespace roomscribe
