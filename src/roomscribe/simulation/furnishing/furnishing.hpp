// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/scenario.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

/// Adds what a plan says, with its truth. Furniture becomes a piece with a box, its doors, drawer
/// fronts and tops as faces where they are (an open door's polygon is turned with it), handles on
/// their face; things on furniture and people's odds and ends are clutter; pictures, boards,
/// radiators, lamps, columns, beams and the like are components with Label::unknown and their kind.
/// Sizes that are 0 take usual ones for the kind, drawn by the style, and so does the elevation of
/// what hangs on a wall. Throws InvalidArgument for a kind that is not known and for sizes or
/// positions that are negative or not finite.
void add_item(SimulatedWorld& world, const ItemPlan& item);

/// The kinds that add_item knows.
std::span<const std::string_view> item_kinds();

/// Chooses what stands in a room and where, by its use: along the walls, in groups, free of doors'
/// swing and of windows for what is tall, with a free way from door to door. Items do not run into
/// each other, nor into those that are there already (columns, pipes). `openings` may be those of
/// the whole floor: a door counts for the rooms on both of its sides. A use that is not known is
/// furnished with a bit of everything.
std::vector<ItemPlan> furnish_room(const RoomPlan& room, std::span<const OpeningPlan> openings,
                                   Random& random, std::span<const ItemPlan> already_there = {});

}  // namespace roomscribe
