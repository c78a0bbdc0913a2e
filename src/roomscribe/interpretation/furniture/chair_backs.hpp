// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"

namespace roomscribe {

/// A flat upright face of a chair's back: 0.3 to 0.56 m wide, from a seat's height or higher up to
/// 0.72 to 1.15 m, off walls.
struct ChairBack {
    std::vector<std::uint32_t> voxels;   ///< numbers in FurnitureVoxels, ascending
    std::vector<std::uint32_t> patches;  ///< that it consists of
    PlanRectangle rectangle;
    double bottom = 0.0;  ///< m above the floor
    double top = 0.0;     ///< m above the floor
};

/// By the patches of the voxels; a back that noise parts into several is one.
std::vector<ChairBack> find_chair_backs(const FurnitureVoxels& all);

/// Parts chairs by their backs, which stand apart even where seats touch or were hardly seen: two
/// backs and more in one low draft are chairs, each with what is nearest to its back. A back that
/// no draft has, or that a table's has though it rises beyond the top, is a draft of its own, for
/// complete_chairs to find the rest of.
void part_chairs(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                 std::vector<PieceDraft>& drafts);

}  // namespace roomscribe
