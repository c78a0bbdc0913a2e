// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "roomscribe/interpretation/furniture/piece_form.hpp"

namespace roomscribe {

/// A piece that is more likely none, or another's part, is not listed.
inline constexpr double min_piece_confidence = 0.5;

/// What a draft is held to be.
struct PieceVerdict {
    bool is_furniture = false;
    std::string_view kind;  ///< "other" if unsure; of what is no furniture, empty if unsure
    std::string_view rule;
    std::string_view alternative;  ///< not empty if doubtful
    double confidence = 0.0;
};

/// The kind whose sizes the draft fits best, by furnishing practice (docs/furniture.md). A
/// confidence is the kind's own times the fit. Chairs and pedestals that were told by how they were
/// drafted are what they were told to be. What fits none well, but stands, is flat-sided and
/// as large as furniture, is "other" with less than min_piece_confidence. No furniture: what is too
/// small, bent (plants, people), part of the building, or hangs before a wall as radiators and
/// curtains do.
PieceVerdict judge_piece(const PieceForm& form);

/// Whether a draft without a seat is a chair's back: upright, which leaves and limbs are not all
/// over, of its size and height, and off the walls, where radiators hang.
bool is_back_of_chair(const PieceForm& form);

/// Whether pieces of a kind are closed by doors or drawers.
bool has_fronts(std::string_view kind);

}  // namespace roomscribe
