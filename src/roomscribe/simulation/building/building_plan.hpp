// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// What sort of place is made up.
enum class SceneKind : std::uint8_t {
    room,      ///< one furnished rectangular room, a hall behind its door
    l_room,    ///< of L shape
    slanted,   ///< with a wall at another angle
    office,    ///< desks, shelves, windows
    kitchen,   ///< base and wall units
    corridor,  ///< with doors on both sides
    flat,      ///< a hall and 2 to 5 rooms
    floor      ///< a corridor and 12 rooms or more
};
inline constexpr std::array<std::string_view, 8> scene_kind_names{
    "room", "l_room", "slanted", "office", "kitchen", "corridor", "flat", "floor"};

/// Makes up rooms with their openings: the same kind and seed, the same building. No items, no
/// stations. Sizes are of real buildings (docs/simulation.md, "Buildings").
Scenario plan_building(SceneKind kind, std::uint64_t seed);

/// The rooms that are scanned: the main room; the corridor; all rooms of a flat or floor whose door
/// a person or robot could pass. Indices into scenario.rooms, in the order of a walk.
std::vector<std::size_t> rooms_to_scan(SceneKind kind, const Scenario& scenario);

}  // namespace roomscribe
