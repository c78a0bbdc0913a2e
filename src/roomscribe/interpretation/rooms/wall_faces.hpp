// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/rooms/floor_plan.hpp"
#include "roomscribe/interpretation/rooms/ray_sample.hpp"
#include "roomscribe/interpretation/rooms/upright_surfaces.hpp"

namespace roomscribe {

/// m. What is told from its wall by a step: twice what walls may be out of true over 1 m (DIN
/// 18202, table 3, line 7: 3 mm).
inline constexpr double least_wall_step = 0.006;

/// One face of a wall in one room, or of a roof's slope.
struct WallFace {
    std::int32_t room = no_room;
    Plane plane;            ///< upright, or a slope; the normal looks into the room
    Eigen::Vector3d along;  ///< level, within the plane: up x normal
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< upwards, within the plane
    double start = 0.0;                             ///< m along `along`, of what was seen
    double end = 0.0;
    double bottom = 0.0;  ///< m along `up`, of what was seen
    double top = 0.0;
    double area = 0.0;  ///< m2, of what was seen
    double rms = 0.0;
    double noise = 0.0;  ///< m, of most of its voxels (SurfaceSample::noise_of_voxel)
    bool reaches_floor = false;
    bool reaches_ceiling = false;
    std::vector<std::uint32_t> voxels;  ///< of the surface sample

    double width() const { return end - start; }
};

/// The upright surfaces that close the rooms: where one parts the room before it from something
/// else. What stands within a room closes nothing. Leaves, panes and other things set in a wall are
/// part of that wall's face and no faces of their own; so is what `rays` pass over, under the
/// ceiling. The largest first.
std::vector<WallFace> find_wall_faces(std::span<const Ray> rays, const SurfaceSample& sample,
                                      std::span<const PlanarPatch> patches,
                                      std::span<const UprightSurface> surfaces,
                                      const FloorPlan& plan, const Eigen::Matrix3d& room_from_map,
                                      const RoomSurfacesSettings& settings);

}  // namespace roomscribe
