// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/scenario.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

/// Adds what fills an opening: lining or reveal, threshold, frame, leaves, levers, panes, mullions,
/// sill, blind, the back of a niche. `wall` and `floor` are the components of the room to which the
/// bare masonry and the threshold belong. The hole in the wall face is the building's. Returns the
/// component that rooms are connected through: the door, or for a passage the `opening`; -1 for the
/// others.
std::int32_t add_opening(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site,
                         std::int32_t wall, std::int32_t floor);

}  // namespace roomscribe
