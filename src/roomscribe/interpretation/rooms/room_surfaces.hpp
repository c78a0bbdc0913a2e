// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/interpretation/rooms/floor_plan.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces_settings.hpp"
#include "roomscribe/interpretation/rooms/wall_faces.hpp"
#include "roomscribe/interpretation/upright/upright.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/model/scene.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// A floor, ceiling or wall, and the voxels of the surface sample that it was made of.
struct RoomSurface {
    Component component;
    Plane plane;  ///< in the map frame; the normal looks into the room
    std::vector<std::uint32_t> voxels;
};

/// A storey's plan and the faces of its walls.
struct StoreyLayout {
    FloorPlan plan;
    std::vector<WallFace> faces;
    std::vector<std::size_t> wall_of_face;      ///< numbers in RoomSurfaces::surfaces
    std::vector<WallFace> slopes;               ///< of the roof over its rooms
    std::vector<std::size_t> ceiling_of_slope;  ///< numbers in RoomSurfaces::surfaces
    std::vector<std::string> room_ids;          ///< of the plan's rooms
    double floor_height = 0.0;                  ///< m along up
};

struct RoomSurfaces {
    /// Map frame -> room frame: z up, the lowest floor at z = 0 (the lowest surface, where no floor
    /// was seen), x and y along the walls, the surfaces' bounding box starting at x = y = 0.
    Transform room_from_map = Transform::Identity();
    std::vector<RoomSurface> surfaces;  ///< floors, ceilings, walls
    std::vector<Room> rooms;
    std::vector<StoreyLayout> storeys;
    /// Per voxel of the sample: part of a thing that hangs flat on a wall (mark_hung_things).
    std::vector<bool> is_hung;
};

/// Rooms with their floors, ceilings and walls, by the paper's pass-through along z (section 4.3)
/// and beyond it.
///
/// Floor: the lowest large level surface that looks up, with all that lies at its level. Ceiling:
/// large level surfaces at least `min_room_height` above it, at any number of heights. A level with
/// a ceiling closely below and another far above is the next storey's floor. Each storey is drawn
/// as a plan and parted into rooms (draw_floor_plan); a room has one floor and one ceiling, and a
/// wall for each face that closes it (find_wall_faces). Sloping ceilings (under roofs) are doubtful
/// ones. Where nothing tells rooms, level and tall surfaces are taken as they are, without a room.
///
/// `component.polygon` is the room's outline for a floor or ceiling, and the rectangle from floor
/// to ceiling of a wall (to the end of what was seen, where there is no floor or ceiling). Nothing
/// found gives an empty table.
RoomSurfaces find_room_surfaces(std::span<const Ray> rays, const SurfaceSample& sample,
                                std::span<const PlanarPatch> patches, const Upright& upright,
                                const RoomSurfacesSettings& settings = {},
                                const Context& context = {});

}  // namespace roomscribe
