// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"

namespace roomscribe {

/// What a level slab is by its height and size.
enum class SlabUse : std::uint8_t {
    seat,   ///< of a chair or stool
    low,    ///< of a sofa, bed, bench, coffee table, low cabinet
    table,  ///< of a table, desk, counter, cabinet, worktop
    high    ///< board or top of something tall, underside of something that hangs
};

SlabUse use_of(const LevelSlab& slab);

/// Voxels that are one thing, before it is known what.
struct PieceDraft {
    std::vector<std::uint32_t> voxels;  ///< numbers in FurnitureVoxels, ascending
    std::vector<std::size_t> slabs;     ///< numbers of its slabs, the largest first; may be empty
    bool is_chair = false;              ///< a chair's back with what is below and before it
    bool is_under_top = false;          ///< a box that was parted from the table above it
};

/// Parts what stands in the rooms into things that may be pieces of furniture.
///
/// Voxels that hang together are one thing unless their level slabs say that they are several: a
/// chair's seat under a table, tops side by side at different heights or too large for one. Slabs
/// above each other are boards of one shelf if they have its size, and things on it (left out) or
/// parts of it if they are smaller; low narrow ones beside a seat are arms and backs. Then every
/// voxel goes to the nearest slab above it within that slab's rectangle, or, for seats, below it.
/// What stands on a top is left out. What is left beside is a thing of its own, cut where the front
/// steps back or the top steps down, as they do from one piece of a row to the next.
std::vector<PieceDraft> draft_pieces(const FurnitureVoxels& all, std::span<const LevelSlab> slabs);

}  // namespace roomscribe
