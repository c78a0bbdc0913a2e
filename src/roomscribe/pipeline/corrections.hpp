// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "roomscribe/model/correction.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe {

/// What became of corrections.
struct CorrectionOutcome {
    std::size_t num_applied = 0;
    std::vector<std::string> unmatched;  ///< one line each: a correction that no element answers to
};

/// Applies corrections, in their order, to scene and point labels. An element answers to a
/// correction if it has its label and lies there: flat ones by plane (10 degrees, 0.15 m) and a
/// middle within half of their longer side, boxes by a middle within half of their middle extent (5
/// cm at least); the nearest wins. A pinned element that was not found again is added. A rejected
/// one goes, with what is mounted on it; its points are unknown. Corrected elements are accepted,
/// with confidence 1, and say so in their evidence. Corrections are in the map's own coordinates.
CorrectionOutcome apply_corrections(Reconstruction& reconstruction,
                                    std::span<const Correction> corrections);

}  // namespace roomscribe
