// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/interpretation/openings/face_axes.hpp"
#include "roomscribe/interpretation/rooms/wall_rectangle.hpp"

namespace roomscribe {

/// A rectangle of a door's size that stands on the floor and whose border steps out of the wall
/// around it, as casings and proud leaves do, or into it, as recessed frames do.
struct DoorOutline {
    WallRectangle border;
    double step = 0.0;      ///< m, from the wall around it outwards; < 0 into the wall
    double inside = 0.0;    ///< m before the face, of what lies within, along the border
    double contrast = 0.0;  ///< of the lowest of its three steps, in the least that counts
};

/// The outlines of doors in a wall: steps that run straight from the floor to one height on both
/// sides and straight across above, all three alike, and end there. Read off the median depths of
/// strips a centimetre wide, which tell steps far below the noise of a point, where cells of a
/// casing's width mix it with what is beside it. What is inside does not matter: a leaf, panes
/// between stiles, or a way through. The wall above must be seen. Single leaves before double ones,
/// which need a casing; the clearest first; no two share a column.
///
/// `near`: the points closely before and behind the wall's face. `wall`: where it was
/// seen, from its floor on.
std::vector<DoorOutline> find_door_outlines(std::span<const FacePlace> near,
                                            const WallRectangle& wall);

}  // namespace roomscribe
