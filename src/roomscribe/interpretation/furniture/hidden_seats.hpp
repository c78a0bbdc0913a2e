// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"

namespace roomscribe {

/// Gives backs of chairs, of which the seat hangs together with a table or with nothing
/// (is_back_of_chair), what lies below and before them where seat and legs are: seats that were
/// drafted without a back, what no draft has, and of a table's draft what carries no top. Before a
/// back is the side on which more of it lies.
void complete_chairs(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                     const RoomSurfaces& surfaces, std::vector<PieceDraft>& drafts);

}  // namespace roomscribe
