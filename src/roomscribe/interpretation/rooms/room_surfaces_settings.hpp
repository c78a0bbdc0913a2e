// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/settings.hpp"

namespace roomscribe {

struct RoomSurfacesSettings {
    double level_tolerance = 0.08;
    double min_room_height = 2.0;
    double ceiling_reach = 0.3;
    double min_wall_height = 0.9;
    double min_free_wall_height = 1.5;
    double min_closing_top = 1.2;
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
             .doc = "A wall is seen to this distance from the ceiling (cornices and lamps may hide "
                    "the rest, a lintel over a door is higher); a wardrobe ends lower."});
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
        visitor(min_closing_top,
                {.name = "min_closing_top",
                 .unit = "m",
                 .min = 0.0,
                 .max = 10.0,
                 .doc = "A surface behind which nothing was seen closes a room if it reaches so "
                        "high above the floor: desks, base units and sideboards are lower."});
        visitor(max_gap,
                {.name = "max_gap",
                 .unit = "m",
                 .min = 0.0,
                 .max = 100.0,
                 .doc = "Coplanar pieces further apart are different walls: the width of a "
                        "double door or a large window."});
    }
};

}  // namespace roomscribe
