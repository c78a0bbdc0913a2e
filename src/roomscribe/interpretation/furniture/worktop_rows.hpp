// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"

namespace roomscribe {

/// Joins the parts of a kitchen's row: what stands in line under one worktop is one piece, though
/// sinks, hobs and shadows part the worktop, and scanners below it see fronts alone.
void join_worktop_rows(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                       const RoomSurfaces& surfaces, std::vector<PieceDraft>& drafts);

}  // namespace roomscribe
