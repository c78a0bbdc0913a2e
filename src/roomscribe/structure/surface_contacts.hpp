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

/// Makes one of surfaces that touch without a step: growing and the tiles of relief may cut a
/// surface in two, one that is out of true most of all. They are one where their planes agree where
/// they touch (2 degrees, the noise), or where neighbouring voxels of both lie within the noise of
/// each other, the planes part by 5 degrees at most, and one plane holds nearly all of both.
/// `graph` is of the sample.
void merge_touching(const ScanMap& map, const SurfaceSample& sample, const NeighborGraph& graph,
                    const PlaneGrowingSettings& settings, std::vector<Surface>& surfaces);

}  // namespace roomscribe
