// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"

namespace roomscribe {

/// Makes drafts of their own of pedestals: boxes of drawers that roll under a table or desk and end
/// below its top with a gap, where what carries the top reaches it. Told by their front, near the
/// edge of the top; all that lies behind it as deep as pedestals are is theirs, whichever draft had
/// it. They are appended, with `is_under_top`.
void part_pedestals(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                    std::vector<PieceDraft>& drafts);

}  // namespace roomscribe
