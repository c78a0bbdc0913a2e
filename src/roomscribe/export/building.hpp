// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/export/walls.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// Rooms whose floors lie about level.
struct BuildingStorey {
    double elevation = 0.0;          ///< m, of its lowest floor, in the room frame
    double height = 0.0;             ///< m, from there to its highest ceiling
    std::vector<std::size_t> rooms;  ///< into Scene::rooms
};

/// A hole in a wall, with what fills it.
struct Opening {
    std::size_t wall = 0;
    std::optional<std::size_t> filling;  ///< door or window; none in a passage
    std::optional<std::size_t> frame;
    std::optional<std::size_t> passage;  ///< component of an opening that nothing fills
    /// m along the wall's axis from its start, and z: the outer edge of the frame where it has one.
    double from = 0.0;
    double to = 0.0;
    double bottom = 0.0;
    double top = 0.0;

    std::size_t component() const { return filling ? *filling : frame ? *frame : *passage; }
};

/// A scene as builders see it. Indices are into `scene`, which is in the room frame and without
/// what is rejected.
struct Building {
    Scene scene;
    std::vector<BuildingStorey> storeys;  ///< from below; at least one
    std::vector<Wall> walls;
    std::vector<Opening> openings;
    /// Per component: by its parents, else the room that it stands in; empty where there is none.
    std::vector<std::optional<std::size_t>> room_of;
    std::vector<std::size_t> storey_of;  ///< per component
};

/// Faces within 0.6 m that stand back to back become one wall; a lone face gets a nominal thickness
/// behind it. Walls that almost meet are joined: their axes cross, their bodies touch. Doors,
/// windows and passages open the wall that they lie in; one that lies in none is no opening. Holes
/// are given as they were measured, also where they reach beyond their wall.
Building describe_building(const Scene& scene);

/// Width and height of something flat that stands: along the horizontal in its plane, and across
/// it. Of something that lies, along its first edge and across it. Zero for what has no polygon.
struct ComponentSize {
    double width = 0.0;
    double height = 0.0;
};
ComponentSize flat_size(const Component& component);

/// Of the box: the longer horizontal axis, the shorter, the axis that is nearest to upright.
struct BoxSize {
    double width = 0.0;
    double depth = 0.0;
    double height = 0.0;
};
BoxSize box_size(const OrientedBox& box);

/// Height of the floor of the room that a component is in, else of its storey.
double floor_below(const Building& building, std::size_t component);
/// The frame of a door or window; null where it has none in its wall.
const Component* frame_around(const Building& building, std::size_t filling);

/// By id; empty if there is none.
std::optional<std::size_t> find_component(const Scene& scene, std::string_view id);
std::optional<std::size_t> find_room(const Scene& scene, std::string_view id);

/// Floor outline of a room in the plan.
std::vector<Eigen::Vector2d> plan_of_room(const Room& room);

}  // namespace roomscribe
