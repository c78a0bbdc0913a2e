// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

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

/// Where seat and legs of a chair are, by its back.
struct ChairPlace {
    PlanRectangle back;
    Eigen::Vector2d forward;  ///< unit vector, from the back over the seat

    bool holds(const Eigen::Vector2d& place) const;
};

/// Whether one flat upright surface closes what is below a back, as the lower half of a front does.
/// Legs in line are flat, too, but leave most open; hind legs lie in the back's own plane.
/// `below`: numbers in FurnitureVoxels, of which those up to a seat's height count.
bool is_closed_below(const FurnitureVoxels& all, std::span<const std::uint32_t> below,
                     std::span<const std::uint32_t> back_patches, double width);

/// By the patches of the voxels; a back that noise parts into several is one.
std::vector<ChairBack> find_chair_backs(const FurnitureVoxels& all);

/// Parts chairs by their backs, which stand apart even where seats touch or were hardly seen: two
/// backs and more in one low draft are chairs, each with what is nearest to its back. A back that
/// no draft has, or that a table's has though it rises beyond the top, is a draft of its own, for
/// complete_chairs to find the rest of.
void part_chairs(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                 std::vector<PieceDraft>& drafts);

}  // namespace roomscribe
