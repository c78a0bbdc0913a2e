// SPDX-License-Identifier: MIT
#include "roomscribe/export/building.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

/// Half the height of the lowest rooms that people walk in: floors that differ by less are of one
/// storey, with steps in it.
constexpr double half_storey = 1.1;
/// A threshold or step between what stands on a floor and the floor.
constexpr double step = 0.3;
/// Steeper polygons are walls, flatter ones floors and roofs.
constexpr double upright_cosine = 0.7;
/// A leaf may lie before or behind its wall by the depth of its lining.
constexpr double lining_depth = 0.25;
/// Walls that are built by eye, and leaves that were fitted while they stood ajar.
constexpr double opening_angle = radians(15.0);
/// From where a wall is first seen to be a room's side, across its face.
constexpr double side_step = 0.05;

std::optional<Eigen::Vector3d> center_of(const Component& component) {
    if (component.box) return component.box->center;
    if (!component.polygon.empty()) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const Eigen::Vector3d& corner : component.polygon)
            sum += corner;
        return sum / static_cast<double>(component.polygon.size());
    }
    if (component.grasp) return component.grasp->position;
    return std::nullopt;
}

std::optional<std::size_t> room_of(const Scene& scene, const Component& component) {
    const Component* at = &component;
    // A chain of parents that bites its own tail is no longer than there are components.
    for (std::size_t i = 0; i <= scene.components.size() && at != nullptr; ++i) {
        if (const auto room = find_room(scene, at->parent)) return room;
        const auto parent = find_component(scene, at->parent);
        at = parent ? &scene.components[*parent] : nullptr;
    }
    const std::optional<Eigen::Vector3d> center = center_of(component);
    if (!center) return std::nullopt;
    for (std::size_t i = 0; i < scene.rooms.size(); ++i) {
        const Room& room = scene.rooms[i];
        if (center->z() > room.floor_height - step && center->z() < room.ceiling_height + step &&
            is_inside(plan_of_room(room), center->head<2>())) {
            return i;
        }
    }
    return std::nullopt;
}

std::vector<BuildingStorey> find_storeys(const std::vector<Room>& rooms) {
    std::vector<std::size_t> order(rooms.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return rooms[a].floor_height < rooms[b].floor_height;
    });
    std::vector<BuildingStorey> storeys;
    for (const std::size_t i : order) {
        const Room& room = rooms[i];
        if (storeys.empty() || room.floor_height > storeys.back().elevation + half_storey)
            storeys.push_back({room.floor_height, 0.0, {}});
        BuildingStorey& storey = storeys.back();
        storey.rooms.push_back(i);
        storey.height = std::max(storey.height, room.ceiling_height - storey.elevation);
    }
    if (storeys.empty()) storeys.emplace_back();
    for (BuildingStorey& storey : storeys)
        std::sort(storey.rooms.begin(), storey.rooms.end());
    return storeys;
}

std::size_t storey_at(const std::vector<BuildingStorey>& storeys, double z) {
    std::size_t storey = 0;
    while (storey + 1 < storeys.size() && storeys[storey + 1].elevation - step <= z)
        ++storey;
    return storey;
}

std::size_t storey_of(const Building& building, std::size_t component) {
    if (const auto room = building.room_of[component]) {
        for (std::size_t i = 0; i < building.storeys.size(); ++i) {
            const auto& rooms = building.storeys[i].rooms;
            if (std::find(rooms.begin(), rooms.end(), *room) != rooms.end()) return i;
        }
    }
    const auto center = center_of(building.scene.components[component]);
    return center ? storey_at(building.storeys, center->z()) : 0;
}

/// The way along an upright polygon, horizontal, with the normal's side to its left; empty if it
/// does not stand upright.
std::optional<Eigen::Vector2d> way_along(const Corners& corners) {
    const Eigen::Vector3d normal = area_vector(corners);
    if (normal.norm() < 1e-9 || std::abs(normal.z()) > upright_cosine * normal.norm()) return {};
    return Eigen::Vector2d(normal.y(), -normal.x()).normalized();
}

/// Extent of a polygon along a horizontal way from an origin, and upwards.
struct Span {
    double from = std::numeric_limits<double>::infinity();
    double to = -std::numeric_limits<double>::infinity();
    double bottom = std::numeric_limits<double>::infinity();
    double top = -std::numeric_limits<double>::infinity();
};

Span span_of(const Corners& corners, const Eigen::Vector2d& origin, const Eigen::Vector2d& along) {
    Span span;
    for (const Eigen::Vector3d& corner : corners) {
        const double station = along.dot(corner.head<2>() - origin);
        span.from = std::min(span.from, station);
        span.to = std::max(span.to, station);
        span.bottom = std::min(span.bottom, corner.z());
        span.top = std::max(span.top, corner.z());
    }
    return span;
}

std::optional<FaceInPlan> wall_face(const Building& building, std::size_t index) {
    const Component& component = building.scene.components[index];
    std::optional<Eigen::Vector2d> along = way_along(component.polygon);
    if (!along) return std::nullopt;
    const Eigen::Vector2d middle = center_of(component)->head<2>();
    if (const auto room = building.room_of[index]) {
        const std::vector<Eigen::Vector2d> plan = plan_of_room(building.scene.rooms[*room]);
        const Eigen::Vector2d left(-along->y(), along->x());
        const bool in_left = is_inside(plan, middle + side_step * left);
        const bool in_right = is_inside(plan, middle - side_step * left);
        if (in_right && !in_left) along = -*along;
    }
    const Span span = span_of(component.polygon, middle, *along);
    if (span.to - span.from < 1e-3 || span.top - span.bottom < 1e-3) return std::nullopt;
    return FaceInPlan{index, middle + span.from * *along, middle + span.to * *along, span.bottom,
                      span.top};
}

std::vector<Wall> find_walls(const Building& building) {
    std::vector<Wall> walls;
    for (std::size_t storey = 0; storey < building.storeys.size(); ++storey) {
        std::vector<FaceInPlan> faces;
        for (std::size_t i = 0; i < building.scene.components.size(); ++i) {
            if (building.scene.components[i].label != Label::wall) continue;
            if (building.storey_of[i] != storey) continue;
            if (const auto face = wall_face(building, i)) faces.push_back(*face);
        }
        for (Wall& wall : pair_faces(faces)) {
            wall.storey = storey;
            wall.id = building.scene.components[wall.faces.front().component].id;
            walls.push_back(std::move(wall));
        }
    }
    return walls;
}

/// How far, m, something upright lies beside the body of a wall; empty if it does not lie along it.
std::optional<double> distance_to_wall(const Wall& wall, const Component& component) {
    const std::optional<Eigen::Vector2d> along = way_along(component.polygon);
    if (!along || std::abs(along->dot(wall.along())) < std::cos(opening_angle)) return {};
    const Span span = span_of(component.polygon, wall.start, wall.along());
    const double middle = 0.5 * (span.from + span.to);
    if (middle < 0.0 || middle > wall.length()) return std::nullopt;
    if (span.top < wall.bottom || span.bottom > wall.top) return std::nullopt;
    const double offset = wall.left().dot(center_of(component)->head<2>() - wall.start);
    return std::max(0.0, std::abs(offset) - 0.5 * wall.thickness);
}

/// The wall that a parent names, else the nearest that it can lie in.
std::optional<std::size_t> wall_of(const Building& building, std::size_t component) {
    const Component& opening = building.scene.components[component];
    std::optional<std::size_t> best;
    double nearest = lining_depth;
    for (std::size_t i = 0; i < building.walls.size(); ++i) {
        const Wall& wall = building.walls[i];
        const bool is_parent =
            std::any_of(wall.faces.begin(), wall.faces.end(), [&](const FaceInPlan& face) {
                return building.scene.components[face.component].id == opening.parent;
            });
        if (is_parent && way_along(opening.polygon)) return i;
        if (building.storey_of[component] != wall.storey) continue;
        const auto distance = distance_to_wall(wall, opening);
        if (!distance || *distance >= nearest) continue;
        nearest = *distance;
        best = i;
    }
    return best;
}

/// Around a door, a window, or a passage whose door is gone.
bool is_frame_of(const Component& frame, const Opening& opening,
                 const std::vector<Component>& components) {
    if (opening.passage) return frame.label == Label::door_frame;
    if (!opening.filling) return false;
    const Label label = components[*opening.filling].label;
    return (label == Label::door && frame.label == Label::door_frame) ||
           (label == Label::window && frame.label == Label::window_frame);
}

void set_span(Opening& opening, const Wall& wall, const Corners& corners) {
    const Span span = span_of(corners, wall.start, wall.along());
    opening.from = span.from;
    opening.to = span.to;
    opening.bottom = span.bottom;
    opening.top = span.top;
}

/// The frame goes to the filling or passage that it is around: the one whose middle it holds.
void add_frame(Building& building, std::size_t index, std::size_t wall_index) {
    const Component& frame = building.scene.components[index];
    const Wall& wall = building.walls[wall_index];
    Opening around;
    set_span(around, wall, frame.polygon);
    for (Opening& opening : building.openings) {
        if (opening.wall != wall_index || opening.frame) continue;
        if (!is_frame_of(frame, opening, building.scene.components)) continue;
        const double station = 0.5 * (opening.from + opening.to);
        const double height = 0.5 * (opening.bottom + opening.top);
        if (station < around.from || station > around.to || height < around.bottom ||
            height > around.top) {
            continue;
        }
        opening.frame = index;
        opening.from = std::min(opening.from, around.from);
        opening.to = std::max(opening.to, around.to);
        opening.bottom = std::min(opening.bottom, around.bottom);
        opening.top = std::max(opening.top, around.top);
        return;
    }
    around.wall = wall_index;
    around.frame = index;
    building.openings.push_back(around);
}

void find_openings(Building& building) {
    const std::vector<Component>& components = building.scene.components;
    for (std::size_t i = 0; i < components.size(); ++i) {
        const bool is_passage =
            components[i].label == Label::unknown && components[i].kind == "opening";
        const bool is_filling =
            components[i].label == Label::door || components[i].label == Label::window;
        if (!is_passage && !is_filling) continue;
        const auto wall = wall_of(building, i);
        if (!wall) continue;
        Opening& opening = building.openings.emplace_back();
        opening.wall = *wall;
        (is_filling ? opening.filling : opening.passage) = i;
        set_span(opening, building.walls[*wall], components[i].polygon);
    }
    for (std::size_t i = 0; i < components.size(); ++i) {
        if (components[i].label != Label::door_frame && components[i].label != Label::window_frame)
            continue;
        if (const auto wall = wall_of(building, i)) add_frame(building, i, *wall);
    }
}

/// A window at the outer face of a wall of which the inner is known says how thick it is at least.
void deepen_walls(Building& building) {
    for (const Opening& opening : building.openings) {
        Wall& wall = building.walls[opening.wall];
        if (wall.thickness_source == ThicknessSource::measured) continue;
        double depth = 0.0;
        for (const auto& component : {opening.filling, opening.frame}) {
            if (!component) continue;
            const Eigen::Vector2d center =
                center_of(building.scene.components[*component])->head<2>();
            depth = std::max(depth, 0.5 * wall.thickness - wall.left().dot(center - wall.start));
        }
        if (depth <= wall.thickness) continue;
        const Eigen::Vector2d shift = 0.5 * (wall.thickness - depth) * wall.left();
        wall.start += shift;
        wall.end += shift;
        wall.thickness = depth;
        wall.thickness_source = ThicknessSource::openings;
    }
}

/// Joins move the starts of walls; stations of openings are counted from there.
void join(Building& building) {
    std::vector<Eigen::Vector2d> starts;
    for (const Wall& wall : building.walls)
        starts.push_back(wall.start);
    join_walls(building.walls);
    for (Opening& opening : building.openings) {
        const Wall& wall = building.walls[opening.wall];
        const double shift = wall.along().dot(starts[opening.wall] - wall.start);
        opening.from += shift;
        opening.to += shift;
    }
}

}  // namespace

Building describe_building(const Scene& scene) {
    Building building;
    building.scene = transformed_scene(scene, scene.room_from_map);
    std::erase_if(building.scene.components, [](const Component& component) {
        return component.verdict == Verdict::rejected;
    });
    building.storeys = find_storeys(building.scene.rooms);
    for (const Component& component : building.scene.components)
        building.room_of.push_back(room_of(building.scene, component));
    for (std::size_t i = 0; i < building.scene.components.size(); ++i)
        building.storey_of.push_back(storey_of(building, i));
    building.walls = find_walls(building);
    find_openings(building);
    deepen_walls(building);
    join(building);
    return building;
}

ComponentSize flat_size(const Component& component) {
    const Corners& corners = component.polygon;
    if (corners.size() < 3) return {};
    const Eigen::Vector3d normal = area_vector(corners).normalized();
    Eigen::Vector3d along = corners[1] - corners[0];
    if (const auto way = way_along(corners)) along = {way->x(), way->y(), 0.0};
    along.normalize();
    // In its plane, which may lean.
    const Eigen::Vector3d across = normal.cross(along);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d high = -low;
    for (const Eigen::Vector3d& corner : corners) {
        const Eigen::Vector2d place(along.dot(corner), across.dot(corner));
        low = low.cwiseMin(place);
        high = high.cwiseMax(place);
    }
    return {high.x() - low.x(), high.y() - low.y()};
}

BoxSize box_size(const OrientedBox& box) {
    std::size_t upright = 0;
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
        if (std::abs(box.axes[axis].z()) > std::abs(box.axes[upright].z())) upright = axis;
    }
    const auto size = [&](std::size_t axis) { return box.size(static_cast<Eigen::Index>(axis)); };
    const double a = size((upright + 1) % 3);
    const double b = size((upright + 2) % 3);
    return {std::max(a, b), std::min(a, b), size(upright)};
}

std::optional<std::size_t> find_component(const Scene& scene, std::string_view id) {
    for (std::size_t i = 0; i < scene.components.size(); ++i) {
        if (scene.components[i].id == id) return i;
    }
    return std::nullopt;
}

std::optional<std::size_t> find_room(const Scene& scene, std::string_view id) {
    for (std::size_t i = 0; i < scene.rooms.size(); ++i) {
        if (scene.rooms[i].id == id) return i;
    }
    return std::nullopt;
}

double floor_below(const Building& building, std::size_t component) {
    const auto room = building.room_of[component];
    return room ? building.scene.rooms[*room].floor_height
                : building.storeys[building.storey_of[component]].elevation;
}

const Component* frame_around(const Building& building, std::size_t filling) {
    for (const Opening& opening : building.openings) {
        if (opening.filling == filling && opening.frame)
            return &building.scene.components[*opening.frame];
    }
    return nullptr;
}

std::vector<Eigen::Vector2d> plan_of_room(const Room& room) {
    std::vector<Eigen::Vector2d> plan;
    for (const Eigen::Vector3d& corner : room.polygon)
        plan.emplace_back(corner.head<2>());
    return plan;
}

}  // namespace roomscribe
