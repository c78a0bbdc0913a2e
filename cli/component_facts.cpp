// SPDX-License-Identifier: MIT
#include "cli/component_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "roomscribe/evaluation/component_fit.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe::cli {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

/// Steeper is upright.
constexpr double level_cosine = 0.7;

const Component* find_component(const Scene& scene, const std::string& id) {
    const auto found = std::find_if(scene.components.begin(), scene.components.end(),
                                    [&](const Component& c) { return c.id == id; });
    return found == scene.components.end() ? nullptr : &*found;
}

Corners in_room(const Scene& scene, const Corners& corners) {
    Corners moved;
    for (const Eigen::Vector3d& corner : corners)
        moved.push_back(scene.room_from_map * corner);
    return moved;
}

Corners corners_of(const OrientedBox& box) {
    Corners corners;
    for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
            for (const double z : {-0.5, 0.5}) {
                corners.emplace_back(box.center + x * box.size.x() * box.axes[0] +
                                     y * box.size.y() * box.axes[1] +
                                     z * box.size.z() * box.axes[2]);
            }
        }
    }
    return corners;
}

double extent_along(const Corners& corners, const Eigen::Vector3d& direction) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector3d& corner : corners) {
        low = std::min(low, direction.dot(corner));
        high = std::max(high, direction.dot(corner));
    }
    return std::max(0.0, high - low);
}

/// `corners` are in the room frame.
std::optional<Extent> extent_of_polygon(const Corners& corners) {
    const std::optional<Plane> plane = plane_of_polygon(corners);
    if (!plane) return std::nullopt;
    Extent extent;
    extent.area = polygon_area(corners);
    extent.is_level = std::abs(plane->normal.z()) > level_cosine;
    if (extent.is_level) {
        extent.width = extent_along(corners, Eigen::Vector3d::UnitX());
        extent.height = extent_along(corners, Eigen::Vector3d::UnitY());
        return extent;
    }
    const Eigen::Vector3d along = Eigen::Vector3d::UnitZ().cross(plane->normal).normalized();
    extent.width = extent_along(corners, along);
    extent.height = extent_along(corners, plane->normal.cross(along));
    return extent;
}

/// The axis that is nearest to the vertical is the height, the longer one of the others the width.
Extent extent_of_box(const Scene& scene, const OrientedBox& box) {
    std::size_t upright = 0;
    double steepest = -1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double rise = std::abs((scene.room_from_map.linear() * box.axes[axis]).z());
        if (rise <= steepest) continue;
        steepest = rise;
        upright = axis;
    }
    const auto size = [&](std::size_t axis) { return box.size(static_cast<Eigen::Index>(axis)); };
    const double a = size((upright + 1) % 3);
    const double b = size((upright + 2) % 3);
    Extent extent;
    extent.width = std::max(a, b);
    extent.height = size(upright);
    extent.depth = std::min(a, b);
    return extent;
}

std::vector<const Component*> parents_of(const Scene& scene, const Component& component) {
    std::vector<const Component*> parents;
    const Component* at = find_component(scene, component.parent);
    // A chain that bites its own tail ends there.
    while (at != nullptr && at != &component &&
           std::find(parents.begin(), parents.end(), at) == parents.end()) {
        parents.push_back(at);
        at = find_component(scene, at->parent);
    }
    return parents;
}

/// Whether a vertical line through a place meets the room's floor, by the parity of crossings.
bool is_in_room(const Corners& floor, const Eigen::Vector3d& place) {
    bool inside = false;
    for (std::size_t i = 0; i < floor.size(); ++i) {
        const Eigen::Vector2d a = floor[i].head<2>() - place.head<2>();
        const Eigen::Vector2d b = floor[(i + 1) % floor.size()].head<2>() - place.head<2>();
        if ((a.y() > 0.0) != (b.y() > 0.0) && (cross(a, b) > 0.0) == (b.y() > a.y()))
            inside = !inside;
    }
    return inside;
}

const Room* room_of(const Scene& scene, const ComponentFacts& facts) {
    const std::string& top =
        facts.parents.empty() ? facts.component->parent : facts.parents.back()->parent;
    for (const Room& room : scene.rooms) {
        if (room.id == top) return &room;
    }
    if (!facts.center) return nullptr;
    for (const Room& room : scene.rooms) {
        if (facts.center->z() >= room.floor_height - 0.1 &&
            facts.center->z() <= room.ceiling_height + 0.1 &&
            is_in_room(in_room(scene, room.polygon), *facts.center)) {
            return &room;
        }
    }
    return nullptr;
}

std::optional<std::array<double, 2>> distances_to_ends(
    const Scene& scene, const Corners& corners, const std::vector<const Component*>& parents) {
    if (parents.empty() || parents.front()->label != Label::wall || corners.empty())
        return std::nullopt;
    const Corners wall = in_room(scene, parents.front()->polygon);
    const std::optional<Plane> plane = plane_of_polygon(wall);
    if (!plane) return std::nullopt;
    const Eigen::Vector3d along = Eigen::Vector3d::UnitZ().cross(plane->normal).normalized();
    const auto bounds = [&](const Corners& points) {
        const auto [low, high] = std::minmax_element(
            points.begin(), points.end(), [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                return along.dot(a) < along.dot(b);
            });
        return std::array{along.dot(*low), along.dot(*high)};
    };
    const auto [start, end] = bounds(wall);
    const auto [low, high] = bounds(corners);
    return std::array{low - start, end - high};
}

/// The frame around an opening, or what a frame is around.
const Component* find_counterpart(const Scene& scene, const Component& component) {
    const auto counterpart_label = [&]() -> std::optional<Label> {
        switch (component.label) {
            case Label::door:
                return Label::door_frame;
            case Label::door_frame:
                return Label::door;
            case Label::window:
                return Label::window_frame;
            case Label::window_frame:
                return Label::window;
            default:
                return std::nullopt;
        }
    }();
    if (!counterpart_label) return nullptr;
    const Component* best = nullptr;
    double most = 0.0;
    for (const Component& other : scene.components) {
        if (other.label != *counterpart_label) continue;
        // As deep as a wall of one brick: a leaf may sit at its far face.
        constexpr double wall_depth = 0.3;
        const auto overlap = overlap_of_polygons(component.polygon, other.polygon, wall_depth);
        if (!overlap || overlap->shared <= most) continue;
        most = overlap->shared;
        best = &other;
    }
    return best;
}

}  // namespace

ComponentFacts gather_facts(const Scene& scene, const Component& component) {
    ComponentFacts facts;
    facts.component = &component;
    facts.parents = parents_of(scene, component);
    if (const auto center = component_center(component))
        facts.center = scene.room_from_map * *center;
    Corners corners = component.box ? corners_of(*component.box) : component.polygon;
    if (corners.empty() && component.grasp) corners.push_back(component.grasp->position);
    corners = in_room(scene, corners);
    if (component.box) {
        facts.extent = extent_of_box(scene, *component.box);
    } else {
        facts.extent = extent_of_polygon(corners);
    }
    facts.room = room_of(scene, facts);
    if (!corners.empty()) {
        double lowest = std::numeric_limits<double>::infinity();
        for (const Eigen::Vector3d& corner : corners)
            lowest = std::min(lowest, corner.z());
        facts.above_floor = lowest - (facts.room != nullptr ? facts.room->floor_height : 0.0);
    }
    facts.to_wall_ends = distances_to_ends(scene, corners, facts.parents);
    for (const Component& other : scene.components) {
        if (other.parent == component.id && &other != &component) facts.parts.push_back(&other);
    }
    facts.counterpart = find_counterpart(scene, component);
    for (const Room& room : scene.rooms) {
        const bool leads_here = std::any_of(
            room.neighbors.begin(), room.neighbors.end(),
            [&](const RoomNeighbor& neighbor) { return neighbor.through == component.id; });
        if (leads_here) facts.joins.push_back(room.id);
    }
    return facts;
}

}  // namespace roomscribe::cli
