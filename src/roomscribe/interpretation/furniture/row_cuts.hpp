// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"

namespace roomscribe {

/// Cuts a row of pieces where its front steps back or its top steps down along its length, by more
/// than what tells one piece from another (fronts, plinths and tops of one piece are in line to a
/// few centimetres). The top is that of the front: what stands on a row stands farther back. One
/// part if there is no such step.
std::vector<std::vector<std::uint32_t>> cut_row(const FurnitureVoxels& all,
                                                std::span<const std::uint32_t> members);

/// m above the floor, where the front of a row ends: what stands on the row rises higher behind it.
/// 0 if too little was seen.
double front_top(const FurnitureVoxels& all, std::span<const std::uint32_t> members);

}  // namespace roomscribe
