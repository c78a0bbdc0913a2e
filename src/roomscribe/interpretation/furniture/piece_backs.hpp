// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// The back of an open shelf that was taken for the wall behind it: voxels of the sample within the
/// shelf's rectangle and height that lie near the wall's face, if they stand off what is seen of
/// the wall around by most of a skirting board's thickness. Ascending; nothing for a shelf without
/// a back, through which the wall itself is seen, and where no wall is seen around. `some` is any
/// of its voxels.
std::vector<std::uint32_t> find_back_on_wall(const SurfaceSample& sample,
                                             const RoomSurfaces& surfaces, const PieceForm& form,
                                             const FurnitureVoxel& some);

}  // namespace roomscribe
