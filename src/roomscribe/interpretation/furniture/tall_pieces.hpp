// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"

namespace roomscribe {

/// What stands taller than any table or chair, from near the floor up without a gap: wardrobes,
/// shelves, fridges, but also columns and people; not a screen on a chest, nor wall units over a
/// worktop, which end or begin where those do. All that lies within the rectangle around such
/// sides and fronts belongs to it; rows are cut (cut_row). The voxels are core voxels no longer.
std::vector<PieceDraft> draft_tall_pieces(FurnitureVoxels& all, const RoomSurfaces& surfaces);

/// The rectangle with what lies between it and the wall that it stands along, where it is no
/// deeper then than a wardrobe; else as it is. `some` is one of its voxels.
PlanRectangle extended_to_wall(PlanRectangle rectangle, const RoomSurfaces& surfaces,
                               const FurnitureVoxel& some);

/// What hangs above a table's height: wall units, shelves on walls, but also lamps. What stands
/// below, on a worktop, may touch a part of it. The voxels are core voxels no longer.
std::vector<PieceDraft> draft_hanging_pieces(FurnitureVoxels& all);

}  // namespace roomscribe
