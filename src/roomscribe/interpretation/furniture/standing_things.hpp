// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/model/label.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// Which voxels of the sample belong to things that stand on the floor of a room: those that no
/// floor, ceiling, wall or opening explains, and that hang together with such voxels close to the
/// floor. What hangs on a wall or from the ceiling is none of these. `labels` are the labels of the
/// map's points so far.
std::vector<bool> find_standing_things(const SurfaceSample& sample, const RoomSurfaces& surfaces,
                                       std::span<const Label> labels, const Context& context = {});

}  // namespace roomscribe
