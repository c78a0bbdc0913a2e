// SPDX-License-Identifier: MIT
#include "roomscribe/export/scene_graph.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "roomscribe/export/json.hpp"
#include "roomscribe/export/rounding.hpp"

namespace roomscribe {
namespace {

using Json = nlohmann::ordered_json;

/// As in scene.json.
template <typename Value>
auto in_steps(const Value& value) {
    return rounded(value, 1e6);
}

Json node_of(const Component& component) {
    Json node = {{"id", component.id}, {"type", label_name(component.label)}};
    if (!component.kind.empty()) node["kind"] = component.kind;
    if (component.box) {
        const BoxSize size = box_size(*component.box);
        node["center"] = in_steps(component.box->center);
        node["size"] = {{"width", in_steps(size.width)},
                        {"depth", in_steps(size.depth)},
                        {"height", in_steps(size.height)}};
    } else if (!component.polygon.empty()) {
        Eigen::Vector3d center = Eigen::Vector3d::Zero();
        for (const Eigen::Vector3d& corner : component.polygon)
            center += corner / static_cast<double>(component.polygon.size());
        const ComponentSize size = flat_size(component);
        node["center"] = in_steps(center);
        node["size"] = {{"width", in_steps(size.width)}, {"height", in_steps(size.height)}};
    }
    if (component.grasp) {
        node["grasp"] = {{"position", in_steps(component.grasp->position)},
                         {"axis", in_steps(component.grasp->axis)},
                         {"approach", in_steps(component.grasp->approach)},
                         {"opening", in_steps(component.grasp->opening)}};
    }
    if (component.opens) node["opens"] = motion_kind_name(component.opens->kind);
    node["confidence"] = in_steps(component.confidence);
    node["verdict"] = verdict_name(component.verdict);
    return node;
}

Json edge(const std::string& from, const std::string& to, const char* relation) {
    return {{"from", from}, {"to", to}, {"relation", relation}};
}

std::string storey_id(std::size_t storey) {
    return fmt::format("storey-{}", storey + 1);
}

/// What holds a component: its parent where that is listed, the wall that an opening lies in, its
/// room, its storey.
std::string holder(const Building& building, std::size_t index) {
    const Scene& scene = building.scene;
    const Component& component = scene.components[index];
    const auto parent = find_component(scene, component.parent);
    if (parent && *parent != index) return component.parent;
    for (const Opening& opening : building.openings) {
        if (opening.filling != index && opening.frame != index && opening.passage != index)
            continue;
        return scene.components[building.walls[opening.wall].faces.front().component].id;
    }
    if (const auto room = building.room_of[index]) return scene.rooms[*room].id;
    return storey_id(building.storey_of[index]);
}

}  // namespace

std::string building_to_graph(const Building& building) {
    const Scene& scene = building.scene;
    Json nodes = Json::array();
    Json edges = Json::array();
    for (std::size_t i = 0; i < building.storeys.size(); ++i) {
        const BuildingStorey& storey = building.storeys[i];
        nodes.push_back({{"id", storey_id(i)},
                         {"type", "storey"},
                         {"elevation", in_steps(storey.elevation)},
                         {"height", in_steps(storey.height)}});
        for (const std::size_t room : storey.rooms)
            edges.push_back(edge(storey_id(i), scene.rooms[room].id, "contains"));
    }
    for (const Room& room : scene.rooms) {
        nodes.push_back({{"id", room.id},
                         {"type", "room"},
                         {"area", in_steps(room.area)},
                         {"volume", in_steps(room.volume)},
                         {"floor_height", in_steps(room.floor_height)},
                         {"ceiling_height", in_steps(room.ceiling_height)}});
        for (const RoomNeighbor& neighbor : room.neighbors) {
            Json leads = edge(room.id, neighbor.room, "leads_to");
            if (!neighbor.through.empty()) leads["through"] = neighbor.through;
            edges.push_back(std::move(leads));
        }
    }
    for (std::size_t i = 0; i < scene.components.size(); ++i) {
        nodes.push_back(node_of(scene.components[i]));
        edges.push_back(edge(holder(building, i), scene.components[i].id, "contains"));
    }
    for (const Wall& wall : building.walls) {
        for (std::size_t i = 1; i < wall.faces.size(); ++i) {
            edges.push_back(edge(scene.components[wall.faces[i].component].id,
                                 scene.components[wall.faces[0].component].id, "back_of"));
        }
    }
    for (const Opening& opening : building.openings) {
        const auto& framed = opening.filling ? opening.filling : opening.passage;
        if (!opening.frame || !framed) continue;
        edges.push_back(
            edge(scene.components[*opening.frame].id, scene.components[*framed].id, "frames"));
    }
    const Json graph = {{"format", "roomscribe-graph"},
                        {"version", 1},
                        {"units", "m"},
                        {"frame", "room"},
                        {"nodes", nodes},
                        {"edges", edges}};
    return lay_out_json(graph.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace roomscribe
