// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/interpretation/openings/wall_openings.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// The components of openings, door and window before their frames, with instances counted on from
/// the surfaces'; each opening learns the numbers of its own. Rooms that a door connects
/// become neighbours.
std::vector<Component> make_opening_components(std::span<WallOpening> openings,
                                               RoomSurfaces& surfaces);

}  // namespace roomscribe
