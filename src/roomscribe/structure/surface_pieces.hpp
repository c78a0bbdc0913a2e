// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/structure/neighbor_graph.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/plane_growing.hpp"
#include "roomscribe/structure/relief_layers.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// A patch and the map's points on it. The patch has no points of its own yet.
struct Surface {
    PlanarPatch patch;
    std::vector<std::uint32_t> map_points;
    std::vector<Eigen::Vector3f> middles;  ///< of its points, by voxel
};

/// Plane, centroid, area and rms of the patch from the surface's points, every voxel counting
/// alike. The normal looks as `facing` does. False if the points lie on one line.
bool fit_surface(const ScanMap& map, const Eigen::Vector3d& facing, double cell_size,
                 Surface& surface);

/// The flat, connected pieces of every layer of relief near each of the grown patches, at the map's
/// density. `grown` and `graph` are of the sample.
std::vector<Surface> split_into_surfaces(const ScanMap& map, const SurfaceSample& sample,
                                         std::span<const PlanarPatch> grown,
                                         const NeighborGraph& graph,
                                         const PlaneGrowingSettings& settings,
                                         const Context& context = {});

}  // namespace roomscribe
