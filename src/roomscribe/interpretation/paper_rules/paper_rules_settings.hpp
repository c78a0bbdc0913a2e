// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "roomscribe/core/settings.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {

/// The numbers of the paper's sections 4.2 and 4.3. Where it gives one, that is the default and the
/// doc says so; the others are choices of ours, which the paper does not state.
struct PaperRulesSettings {
    int min_line_inliers = 25;
    double angle_tolerance = radians(5.0);
    double wall_height = 3.0;
    double door_height = 2.0;
    double door_width = 0.8;
    double window_width = 1.2;
    double window_height = 0.6;
    double size_tolerance = 0.3;
    double edge_distance = 0.15;
    double slice_height = 0.3;
    double wall_depth = 0.3;
    double frame_width = 0.15;
    std::optional<double> boundary_radius;
    std::optional<double> line_tolerance;
    double end_distance = 0.15;

    void visit(SettingVisitor& visitor) {
        const auto length = [&](double& value, const char* name, const char* doc) {
            visitor(value, {.name = name, .unit = "m", .min = 1e-6, .max = 1e3, .doc = doc});
        };
        visitor(min_line_inliers, {.name = "min_line_inliers",
                                   .unit = "",
                                   .min = 2,
                                   .max = 1e9,
                                   .doc = "Fewest boundary points of a line (the paper's 25)."});
        visitor(angle_tolerance, {.name = "angle_tolerance",
                                  .unit = "rad",
                                  .min = 1e-6,
                                  .max = 0.7,
                                  .doc = "Right angles and parallels hold up to this (the paper's "
                                         "90 +- 5 degrees)."});
        length(wall_height, "wall_height", "How high walls are (the paper's 3,000 mm).");
        length(door_height, "door_height", "How high doors are (the paper's 2,000 mm).");
        length(door_width, "door_width", "How wide doors are (the paper's 800 mm).");
        length(window_width, "window_width", "How wide windows are (the paper's 1,200 mm).");
        length(window_height, "window_height", "How high windows are (the paper's 600 mm).");
        visitor(size_tolerance,
                {.name = "size_tolerance",
                 .unit = "",
                 .min = 0.0,
                 .max = 0.95,
                 .doc = "Share by which a size may differ from these (the paper says \"around\"): "
                        "leaves are 0.61 to 1.05 m wide."});
        length(edge_distance, "edge_distance",
               "\"Very close\": a door's edge lies no further from the edge of its wall and from "
               "the floor.");
        length(slice_height, "slice_height",
               "Height of the slices at the bottom and the top that the pass-through filter takes "
               "for floor and ceiling: a tenth of a wall's.");
        length(wall_depth, "wall_depth",
               "Doors and windows lie no deeper in their wall: inner walls and reveals are up to "
               "0.3 m deep.");
        length(frame_width, "frame_width",
               "A quadrilateral that surrounds a door or window by no more is its frame.");
        visitor(boundary_radius, {.name = "boundary_radius",
                                  .unit = "m",
                                  .min = 1e-6,
                                  .max = 1e3,
                                  .doc = "Neighbours of a boundary point lie no further off; auto: "
                                         "four times the point spacing."});
        visitor(line_tolerance,
                {.name = "line_tolerance",
                 .unit = "m",
                 .min = 1e-6,
                 .max = 1e3,
                 .doc = "A boundary point of a line lies no further from it; auto: the point "
                        "spacing, within which a row of points may miss the rim."});
        length(end_distance, "end_distance",
               "Condition (a): \"in the proximity\" of a shape's end is what lies no further off.");
    }
};

}  // namespace roomscribe
