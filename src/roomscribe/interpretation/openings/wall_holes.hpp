// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "roomscribe/interpretation/openings/wall_relief.hpp"

namespace roomscribe {

/// A rectangle of cells: columns [left, right), rows [low, high).
struct CellRectangle {
    int left = 0;
    int right = 0;
    int low = 0;
    int high = 0;
    double sum = 0.0;
};

/// m. Hatches and vents are smaller than a window: smaller holes are not looked for.
inline constexpr double min_window_side = 0.35;

enum class HoleSide : std::uint8_t { left, right, bottom, top };

/// m, at which the cells along the sides lie, and those in the middle, as most of them do.
struct HoleDepths {
    std::optional<double> rim;
    std::optional<double> middle;
    double rim_at_depth = 0.0;  ///< share of the cells along the sides that lie near there
};

/// What the cells of a hole tell.
struct HoleEvidence {
    double seen = 0.0;           ///< share of the cells that are open
    double hidden = 0.0;         ///< share of the cells that only hidden rays were aimed at
    double opaque = 0.0;         ///< share of the open rays that ended in the hole
    double through_share = 0.0;  ///< share of the open cells that most rays went through
    double outdoors = 0.0;       ///< share of these rays that ended below the floor or far away
    double depth = 0.0;          ///< m, at which most of these ended
    double at_depth = 0.0;       ///< share of them that did near it
    /// By side: share of the cells closely around it that are wall, if enough were seen.
    std::array<std::optional<double>, 4> rim;
    double framed = 0.0;  ///< share of the cells along its sides in which rays ended
    double lining = 0.0;  ///< share of its left, right and upper edge at which wall goes inwards
    /// By how much cells without a return are more frequent among the open ones, as panes leave
    /// them, than in the wall around.
    double lost = 0.0;
    /// Rays that meet a cell of its middle, in those that meet one along its sides.
    double thinned = 1.0;
    HoleDepths depths;

    std::optional<double> rim_of(HoleSide side) const {
        return rim[static_cast<std::size_t>(side)];
    }
    /// m, by how much the middle lies deeper than the sides.
    double sunk() const { return depths.rim && depths.middle ? *depths.middle - *depths.rim : 0.0; }
    /// m, of a window's frame.
    double frame_depth() const;
};

/// The holes of a wall's face: of each group of open cells the rectangle that holds the most of
/// them and the least wall. Cells that nothing was seen of do not part a group, and what stands
/// before a hole does not part it: see docs/interpretation.md.
std::vector<CellRectangle> find_wall_holes(const WallRelief& relief);

HoleEvidence look_into(const WallRelief& relief, const CellRectangle& hole);

/// Whether wall was seen on three sides, or two of a hole on the floor, and nothing else on any.
bool is_framed_by_wall(const HoleEvidence& evidence, bool stands_on_floor);

/// m. Panes sit 12 to 90 mm behind the front of sash and frame (profiles of 58 to 92 mm).
inline constexpr double most_sinking = 0.1;

/// Least share `framed` of windows.
inline constexpr double min_framed = 0.25;

/// Whether stiles and a bottom rail in the plane of the wall hold a pane that lies there as well:
/// of a window, frame and reveals show in the hole.
bool is_flush_pane(const HoleEvidence& evidence);

/// The hole's edges to a fraction of a cell: of the cells on either side of an edge, as much
/// belongs to the wall as rays ended on it there.
WallRectangle measure_edges(const WallRelief& relief, const CellRectangle& hole);

/// The row at which a blind ends that hangs before the wall and hides the top of a window: over the
/// hole, as wide, things stand 3 to 10 cm before the wall, and beside that they do not. The hole's
/// own upper row where there is none.
int top_of_blind(const WallRelief& relief, const CellRectangle& hole);

/// Width of the frame within a window's hole, m: from its sides inwards to where rays pass; nothing
/// where that tells no likely width.
std::optional<double> measure_frame(const WallRelief& relief, const CellRectangle& hole);

}  // namespace roomscribe
