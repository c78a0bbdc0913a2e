// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/model/scene.hpp"

namespace roomscribe::test {

/// Two rooms of 4 x 3 m and 3 x 3 m, 2.5 m high, with a wall of 0.12 m between them: room-1 in
/// [0, 4] x [0, 3] and room-2 in [4.12, 7.12] x [0, 3]. Eight faces of walls; door-1 of 0.8 x 2 m
/// in a frame of 0.9 x 2.05 m leads from one to the other; window-1 of 1.2 x 1 m, framed by 0.05 m,
/// lies 0.2 m behind the face of wall-1, 0.9 m up. A cabinet of 0.8 x 0.5 x 0.9 m with a drawer and
/// a handle stands in room-1. In the room frame, where the map is turned and 10 m off.
Scene flat_of_two_rooms();

/// Along x or y, upright, from a lower corner: counter-clockwise as seen from the right of the way.
std::vector<Eigen::Vector3d> upright_rectangle(const Eigen::Vector3d& corner,
                                               const Eigen::Vector3d& along, double height);

}  // namespace roomscribe::test
