// SPDX-License-Identifier: MIT
#pragma once

namespace roomscribe {

// m. Leaves have 0.61 to 1.11 m by 1.985 or 2.11 m (DIN 18101), double ones twice the width; old
// and narrow ones are a little off these.
inline constexpr double min_door_width = 0.55;
inline constexpr double max_door_width = 2.3;
inline constexpr double min_door_height = 1.8;
inline constexpr double max_door_height = 2.5;
inline constexpr double usual_door_height = 2.0;
inline constexpr double max_leaf_width = 1.3;
/// m. The widest single leaf of DIN 18101; the hole in its frame is no wider.
inline constexpr double widest_usual_leaf = 1.11;
/// m. The tallest (2.235 m is the third of its heights).
inline constexpr double tallest_usual_leaf = 2.24;
/// m. Thresholds, skirtings and what lies on the floor.
inline constexpr double floor_reach = 0.25;
/// Of the cells of a leaf, those before which something stands: doors are kept clear, and the back
/// of a shelf has the shelf before it.
inline constexpr double max_covered = 0.25;

}  // namespace roomscribe
