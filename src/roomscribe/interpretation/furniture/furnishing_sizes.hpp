// SPDX-License-Identifier: MIT
#pragma once

namespace roomscribe {

// Sizes by which several steps tell seats and tables apart (docs/furniture.md).

/// m: tables are not deeper than 1.0 and not longer than 2.0 (docs/furniture.md).
inline constexpr double max_table_width = 1.05;
inline constexpr double max_table_length = 2.1;
/// m above the floor: mattresses are lower, tables higher (docs/furniture.md).
inline constexpr double min_table_height = 0.66;
/// m: a chair's seat is at most as wide as an office chair's.
inline constexpr double max_seat_width = 0.62;
/// m above the floor: of seats with their cushions.
inline constexpr double max_seat = 0.56;

}  // namespace roomscribe
