// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

namespace roomscribe {

/// A level board, seat or cushion: a top, or the underside of one that was seen from below.
struct LevelSlab {
    std::vector<std::uint32_t> voxels;  ///< numbers in FurnitureVoxels, ascending
    PlanRectangle rectangle;
    double height = 0.0;      ///< m above the floor, median
    double area = 0.0;        ///< m2
    bool looks_down = false;  ///< it was seen from below
};

/// The level surfaces among the core voxels, of at least the size of a stool's seat, the largest
/// first. Pieces of one top that the shadow of a thing on it parts are one slab. One that is too
/// large for a table is several that touch.
std::vector<LevelSlab> find_level_slabs(const FurnitureVoxels& all, double voxel_size);

/// Share of the slab's voxels that lie within a rectangle grown by a margin.
double share_within(const FurnitureVoxels& all, const LevelSlab& slab,
                    const PlanRectangle& rectangle, double margin);

}  // namespace roomscribe
