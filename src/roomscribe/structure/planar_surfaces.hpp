// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/plane_growing.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// In patch_of_point: on no patch.
inline constexpr std::int32_t no_patch = -1;

/// The planar surfaces of a map at its full density.
struct PlanarSurfaces {
    /// The largest first. `points` number the voxels of the surface sample; plane, rms and area
    /// follow from the map's points.
    std::vector<PlanarPatch> patches;
    std::vector<std::int32_t> patch_of_point;  ///< per point of the map
};

/// All planar surfaces of the map, big and small: patches are grown over the surface sample
/// (grow_planar_patches), the map's points near each are sorted into layers of relief
/// (find_relief_layers), and each connected piece of a layer becomes a patch of its own, with a
/// plane fitted to its points, every stretch of surface counting alike.
PlanarSurfaces find_planar_surfaces(const ScanMap& map, const SurfaceSample& sample,
                                    const PlaneGrowingSettings& settings = {},
                                    const Context& context = {});

}  // namespace roomscribe
