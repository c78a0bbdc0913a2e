// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/interpretation/upright.hpp"
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

struct RoomSurfaces {
    /// Map frame -> room frame: z up, the lowest floor at z = 0 (the lowest surface, where no floor
    /// was seen), x and y along the walls, the surfaces' bounding box starting at x = y = 0.
    Transform room_from_map = Transform::Identity();
    std::vector<RoomSurface> surfaces;  ///< floors, ceilings, walls
    std::vector<Room> rooms;
};

struct RoomSurfacesSettings {
    double level_tolerance = 0.08;
    double min_room_height = 2.0;
    double ceiling_reach = 0.35;
    double min_wall_height = 0.9;
    double min_free_wall_height = 1.5;
    double max_gap = 2.5;

    void visit(SettingVisitor& visitor) {
        visitor(level_tolerance,
                {.name = "level_tolerance",
                 .unit = "m",
                 .min = 0.0,
                 .max = 1.0,
                 .doc = "Level surfaces whose heights differ by no more are one floor "
                        "or ceiling: half a stair's rise."});
        visitor(min_room_height, {.name = "min_room_height",
                                  .unit = "m",
                                  .min = 0.5,
                                  .max = 10.0,
                                  .doc = "Ceilings are at least so high above their floor."});
        visitor(
            ceiling_reach,
            {.name = "ceiling_reach",
             .unit = "m",
             .min = 0.0,
             .max = 10.0,
             .doc = "A wall is seen to this distance from the ceiling (beams, cornices and lamps "
                    "may hide the rest); a cupboard ends lower."});
        visitor(min_wall_height,
                {.name = "min_wall_height",
                 .unit = "m",
                 .min = 0.0,
                 .max = 10.0,
                 .doc = "Least height seen of a wall that reaches the ceiling: more than "
                        "a beam is deep."});
        visitor(
            min_free_wall_height,
            {.name = "min_free_wall_height",
             .unit = "m",
             .min = 0.0,
             .max = 10.0,
             .doc = "Least height seen of a wall where no ceiling was seen: more than a desk or "
                    "a kitchen base unit with its back panel."});
        visitor(max_gap,
                {.name = "max_gap",
                 .unit = "m",
                 .min = 0.0,
                 .max = 100.0,
                 .doc = "Coplanar pieces further apart are different walls: the width of a "
                        "double door or a large window."});
    }
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
RoomSurfaces find_room_surfaces(const ScanMap& map, const SurfaceSample& sample,
                                std::span<const PlanarPatch> patches, const Upright& upright,
                                const RoomSurfacesSettings& settings = {},
                                const Context& context = {});

}  // namespace roomscribe
