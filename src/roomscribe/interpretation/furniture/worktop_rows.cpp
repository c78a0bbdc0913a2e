// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/worktop_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"
#include "roomscribe/interpretation/furniture/row_cuts.hpp"
#include "roomscribe/interpretation/furniture/tall_pieces.hpp"

namespace roomscribe {
namespace {

/// m above the floor: worktops are 0.86 to 0.92 high (docs/furniture.md), and what is seen of the
/// fronts below ends at 0.82; desks are lower.
constexpr double min_worktop = 0.8;
constexpr double max_worktop = 0.98;
/// m: fronts below a worktop end a plate's thickness and a grip lower.
constexpr double max_step = 0.07;
/// m: worktops are 0.60 to 0.63 deep, and overhang; a door may stand open.
constexpr double min_depth = 0.5;
constexpr double max_depth = 0.8;
/// m: the sink or hob between.
constexpr double max_gap = 0.3;
constexpr double max_length = 5.0;

struct RowPart {
    std::size_t draft = 0;
    PlanRectangle rectangle;
    double height = 0.0;
};

RowPart measure(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                const std::vector<PieceDraft>& drafts, std::size_t number) {
    const PieceDraft& draft = drafts[number];
    RowPart part{number, smallest_rectangle(places_of(all, draft.voxels)), 0.0};
    part.height =
        draft.slabs.empty() ? front_top(all, draft.voxels) : slabs[draft.slabs.front()].height;
    return part;
}

bool are_one_row(const FurnitureVoxels& all, const RoomSurfaces& surfaces,
                 const std::vector<PieceDraft>& drafts, const RowPart& a, const RowPart& b) {
    const PieceDraft& of_a = drafts[a.draft];
    const PieceDraft& of_b = drafts[b.draft];
    const FurnitureVoxel& some_a = all.voxels[of_a.voxels.front()];
    const FurnitureVoxel& some_b = all.voxels[of_b.voxels.front()];
    if (some_a.storey != some_b.storey || some_a.room != some_b.room) return false;
    if (std::abs(a.height - b.height) > max_step) return false;
    std::vector<Eigen::Vector2d> places = places_of(all, of_a.voxels);
    const std::vector<Eigen::Vector2d> others = places_of(all, of_b.voxels);
    places.insert(places.end(), others.begin(), others.end());
    const PlanRectangle both = smallest_rectangle(places);
    const double width = std::max(a.rectangle.width, b.rectangle.width);
    // Where only fronts were seen, the wall behind tells how deep they are.
    const double depth = std::max(both.width, extended_to_wall(both, surfaces, some_a).width);
    return depth >= min_depth && both.width <= std::min(max_depth, width + 0.1) &&
           both.length <= std::min(max_length, a.rectangle.length + b.rectangle.length + max_gap);
}

}  // namespace

void join_worktop_rows(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                       const RoomSurfaces& surfaces, std::vector<PieceDraft>& drafts) {
    std::vector<RowPart> parts;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
        if (drafts[i].voxels.empty() || drafts[i].is_chair || drafts[i].is_under_top) continue;
        const RowPart part = measure(all, slabs, drafts, i);
        if (part.height >= min_worktop && part.height <= max_worktop) parts.push_back(part);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (std::size_t j = i + 1; j < parts.size();) {
            if (!are_one_row(all, surfaces, drafts, parts[i], parts[j])) {
                ++j;
                continue;
            }
            PieceDraft& kept = drafts[parts[i].draft];
            PieceDraft& other = drafts[parts[j].draft];
            kept.voxels.insert(kept.voxels.end(), other.voxels.begin(), other.voxels.end());
            std::sort(kept.voxels.begin(), kept.voxels.end());
            kept.slabs.insert(kept.slabs.end(), other.slabs.begin(), other.slabs.end());
            // The largest first: slabs are numbered so.
            std::sort(kept.slabs.begin(), kept.slabs.end());
            other = {};
            parts[i] = measure(all, slabs, drafts, parts[i].draft);
            parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(j));
            j = i + 1;
        }
    }
}

}  // namespace roomscribe
