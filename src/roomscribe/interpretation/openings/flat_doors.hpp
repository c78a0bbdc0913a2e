// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/interpretation/openings/wall_holes.hpp"

namespace roomscribe {

/// A leaf that lies nearly in the plane of its wall.
struct FlatDoor {
    CellRectangle cells;
    double height = 0.0;     ///< m, of the leaf before the wall beside it
    double contrast = 0.0;   ///< in the least difference that counts
    bool has_lintel = true;  ///< wall was seen above it
};

/// Closed leaves nearly in the plane of their wall: rectangles of a door's size, on the floor, that
/// lie a few millimetres deeper than the wall on both sides and above, or have a casing around them
/// that stands out. Two leaves need the casing, and so does one above which the wall shows only in
/// part; where nothing was seen above, as by scanners that look up by few degrees, both sides are
/// enough. Or they stand before the wall, up to 45 mm, on both sides and above, evenly from the
/// floor on and with little before them, as rebated leaves do where they open to. A leaf with a
/// lever needs half the step. A corner closely beside a leaf may hide one side. The clearest first;
/// no two share a column.
std::vector<FlatDoor> find_flat_doors(const WallRelief& relief);

}  // namespace roomscribe
