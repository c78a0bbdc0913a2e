// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/export/building.hpp"

namespace roomscribe {

/// In the order in which they are drawn.
enum class PlanLayer : std::uint8_t {
    rooms,
    furniture,
    walls,
    faces,
    windows,
    doors,
    handles,
    dimensions,
    text,
};
inline constexpr std::array<std::string_view, 9> plan_layer_names{
    "ROOMS", "FURNITURE", "WALLS", "FACES", "WINDOWS", "DOORS", "HANDLES", "DIMENSIONS", "TEXT"};

enum class PlanStroke : std::uint8_t {
    solid,
    dashed,  ///< doubtful, or above the height at which the plan is cut
};

/// A line through corners, or an outline. All lengths are in metres in the room frame.
struct PlanPath {
    PlanLayer layer = PlanLayer::walls;
    std::vector<Eigen::Vector2d> corners;
    bool is_closed = false;
    PlanStroke stroke = PlanStroke::solid;
    std::string id;  ///< of the component or room that it shows
};

/// Counter-clockwise from one angle to the other, radians.
struct PlanArc {
    PlanLayer layer = PlanLayer::doors;
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    double radius = 0.0;
    double from = 0.0;
    double to = 0.0;
    PlanStroke stroke = PlanStroke::solid;
    std::string id;  ///< of the door that swings
};

/// Centred at its position, read along `angle`.
struct PlanText {
    PlanLayer layer = PlanLayer::text;
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    double height = 0.0;  ///< of its capitals
    double angle = 0.0;
    std::string text;
    bool is_strong = false;
};

/// What is seen of a storey from above, cut at about the height of its windows.
struct StoreyPlan {
    std::string title;  ///< "Storey 1"
    double elevation = 0.0;
    std::vector<PlanPath> paths;
    std::vector<PlanArc> arcs;
    std::vector<PlanText> texts;
    Eigen::AlignedBox2d bounds;  ///< of the paths; never empty
};

/// One plan per storey: walls as bands with gaps for their openings, on them the faces that were
/// measured, each a line from end to end; doors with their swing,
/// windows, furniture and handles from above, rooms with name and area, their clear width and depth
/// and the overall size. A door swings as its hinge was found; one that is wider than single leaves
/// are made has two; one of unknown hinge is drawn shut.
std::vector<StoreyPlan> draw_floor_plans(const Building& building);

/// By how far each plan is moved along x, so that they stand beside each other: whole metres.
std::vector<double> plan_shifts(const std::vector<StoreyPlan>& plans);

}  // namespace roomscribe
