// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/rooms/level_surfaces.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces_settings.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// Coplanar upright patches of one storey that are near enough to be one wall.
struct UprightSurface {
    Plane plane;  ///< exactly upright; the normal's sign is the largest patch's
    Eigen::Vector3d along = Eigen::Vector3d::UnitX();  ///< level, within the plane
    double start = 0.0;                                ///< m along `along`, of what was seen
    double end = 0.0;
    double bottom = 0.0;  ///< m along up, of what was seen
    double top = 0.0;
    double area = 0.0;
    double rms = 0.0;
    std::vector<std::uint32_t> patches;

    double height() const { return top - bottom; }
    double width() const { return end - start; }
};

/// All upright surfaces between two heights, walls or not, the largest first.
std::vector<UprightSurface> find_upright_surfaces(const SurfaceSample& sample,
                                                  std::span<const PlanarPatch> patches,
                                                  const Eigen::Vector3d& up, double from, double to,
                                                  const RoomSurfacesSettings& settings);

}  // namespace roomscribe
