// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/level_surfaces.hpp"
#include "roomscribe/interpretation/room_surfaces.hpp"

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
    /// Of the surface that was seen over its width, the share on the emptier side of it.
    double share_behind = 0.5;
    /// Side on which the emptier one is: 1 along the normal, -1 against it, 0 if that is not clear.
    int back_side = 0;
    std::vector<std::uint32_t> patches;

    double height() const { return top - bottom; }
    double width() const { return end - start; }
};

/// All upright surfaces between two heights, walls or not, the largest first.
std::vector<UprightSurface> find_upright_surfaces(const SurfaceSample& sample,
                                                  std::span<const PlanarPatch> patches,
                                                  const Eigen::Vector3d& up, double from, double to,
                                                  const RoomSurfacesSettings& settings);

/// Whether an upright surface is a wall, and why.
struct WallJudgement {
    bool is_wall = false;
    bool reaches_ceiling = false;
    bool reaches_floor = false;
    double confidence = 0.0;
    std::string_view rule;
    std::string_view alternative;  ///< not empty if doubtful
};
WallJudgement judge_wall(const UprightSurface& surface, std::span<const UprightSurface> others,
                         const Storey& storey, const RoomSurfacesSettings& settings);

}  // namespace roomscribe
