// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"

namespace roomscribe {

/// Takes what stands on the boards of an open shelf out of it: all but its boards, its sides, the
/// uprights between its bays and, where `form` tells the wall behind, its back. A board is a height
/// at which level surface is seen along most of the length, which the tops of books are not. What
/// shows fewer than two boards between its lower end and its top is not open and stays as it is.
void drop_shelf_contents(const FurnitureVoxels& all, const PieceForm& form, PieceDraft& draft);

}  // namespace roomscribe
