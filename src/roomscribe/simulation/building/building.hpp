// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/simulation/scenario.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

/// Adds what a building is made of, with its truth: one floor, one ceiling and the wall faces of
/// every room, walls with the holes of their openings, skirting boards, doors, windows, niches, the
/// outer faces and what is seen outdoors. Rooms, their areas and neighbours go to scene.rooms.
/// Walls are uneven by as much as DIN 18202 allows for well finished ones.
/// Throws InvalidArgument for an outline that is no simple polygon or runs clockwise, and for an
/// opening that is on no wall.
void add_building(SimulatedWorld& world, const Scenario& scenario);

}  // namespace roomscribe
