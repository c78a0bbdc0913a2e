// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/model/scan.hpp"
#include "roomscribe/structure/neighbor_graph.hpp"
#include "roomscribe/structure/surface_pieces.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// In owners_of_voxels: no surface.
inline constexpr std::uint32_t no_surface = 0xFFFFFFFFU;

/// Per voxel the surface that has most of its points, or no_surface.
std::vector<std::uint32_t> owners_of_voxels(const SurfaceSample& sample,
                                            std::span<const Surface> surfaces);

/// Makes one of surfaces that touch in one plane: growing may cut a surface in two, which the
/// layers then bring into one plane again. `graph` is of the sample.
void merge_touching(const ScanMap& map, const SurfaceSample& sample, const NeighborGraph& graph,
                    double cell_size, std::vector<Surface>& surfaces);

}  // namespace roomscribe
