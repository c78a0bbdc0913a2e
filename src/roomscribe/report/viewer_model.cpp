// SPDX-License-Identifier: MIT
#include "roomscribe/report/viewer_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "roomscribe/export/building.hpp"
#include "roomscribe/export/rounding.hpp"
#include "roomscribe/export/wall_openings.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/model/label.hpp"

namespace roomscribe {
namespace {

using Json = nlohmann::ordered_json;

/// A tenth of a millimetre is finer than any scanner.
template <typename Value>
auto in_steps(const Value& value) {
    return rounded(value, 1e4);
}

Json to_json(const Eigen::Vector3d& v) {
    return in_steps(v);
}

Json to_json(const std::vector<Eigen::Vector3d>& corners) {
    Json json = Json::array();
    for (const Eigen::Vector3d& corner : corners)
        json.push_back(to_json(corner));
    return json;
}

Json to_json(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json labels_json(const Reconstruction& reconstruction) {
    std::array<std::uint64_t, num_labels> points{};
    for (const Label label : reconstruction.labels.labels)
        ++points[static_cast<std::size_t>(label)];
    Json json = Json::array();
    for (std::size_t id = 0; id < num_labels; ++id) {
        const auto label = static_cast<Label>(id);
        json.push_back(
            {{"name", label_name(label)}, {"color", label_color(label)}, {"points", points[id]}});
    }
    return json;
}

/// Of a box its three extents, else width and height of the polygon: what tables of exports say.
Json sizes_of(const Component& component) {
    if (component.box) {
        const BoxSize size = box_size(*component.box);
        return Json::array({in_steps(size.width), in_steps(size.depth), in_steps(size.height)});
    }
    const ComponentSize size = flat_size(component);
    return Json::array({in_steps(size.width), in_steps(size.height)});
}

Json evidence_json(const Evidence& evidence) {
    return {{"rule", evidence.rule},
            {"points", evidence.points},
            {"scans", evidence.scans},
            {"coverage", to_json(evidence.coverage)},
            {"occluded", to_json(evidence.occluded)},
            {"rms", to_json(evidence.rms)},
            {"alternative", evidence.alternative}};
}

Json component_json(const Building& building, std::size_t index) {
    const Component& component = building.scene.components[index];
    Json json = {{"id", component.id},
                 {"label", static_cast<int>(component.label)},
                 {"kind", component.kind},
                 {"parent", component.parent},
                 {"room", building.room_of[index] ? Json(*building.room_of[index]) : Json(nullptr)},
                 {"verdict", verdict_name(component.verdict)},
                 {"confidence", component.confidence},
                 {"size", sizes_of(component)},
                 {"evidence", evidence_json(component.evidence)}};
    if (component.polygon.size() >= 3) {
        json["area"] = area_vector(component.polygon).norm();
        json["outline"] = to_json(component.polygon);
        Json pieces = Json::array();
        for (const SpacePolygon& piece : pieces_of_component(building, index))
            pieces.push_back(to_json(piece));
        json["pieces"] = std::move(pieces);
    }
    if (component.box) {
        const OrientedBox& box = *component.box;
        json["box"] = {{"center", to_json(box.center)},
                       {"axes", {to_json(box.axes[0]), to_json(box.axes[1]), to_json(box.axes[2])}},
                       {"size", to_json(box.size)}};
    }
    if (component.grasp) {
        json["grasp"] = {{"position", to_json(component.grasp->position)},
                         {"axis", to_json(component.grasp->axis)},
                         {"approach", to_json(component.grasp->approach)},
                         {"opening", in_steps(component.grasp->opening)}};
    }
    if (component.opens) {
        json["opens"] = {{"motion", motion_kind_name(component.opens->kind)},
                         {"point", to_json(component.opens->point)},
                         {"direction", to_json(component.opens->direction)}};
    }
    return json;
}

Json rooms_json(const Scene& scene) {
    Json json = Json::array();
    for (const Room& room : scene.rooms) {
        json.push_back({{"id", room.id},
                        {"polygon", to_json(room.polygon)},
                        {"floor", room.floor_height},
                        {"ceiling", room.ceiling_height},
                        {"area", room.area},
                        {"volume", room.volume}});
    }
    return json;
}

Json scans_json(const Reconstruction& reconstruction) {
    const Transform& room_from_map = reconstruction.scene.room_from_map;
    Json json = Json::array();
    for (const MapSection& section : reconstruction.map.sections) {
        Json scan = {{"name", section.name}, {"first", section.first}, {"count", section.count}};
        if (section.sensor_position) {
            scan["position"] = to_json(room_from_map * *section.sensor_position);
        }
        if (section.sensor_axes) {
            const Eigen::Matrix3d axes = room_from_map.linear() * *section.sensor_axes;
            scan["axes"] = {to_json(Eigen::Vector3d(axes.col(0))),
                            to_json(Eigen::Vector3d(axes.col(1))),
                            to_json(Eigen::Vector3d(axes.col(2)))};
        }
        json.push_back(std::move(scan));
    }
    return json;
}

}  // namespace

std::vector<std::size_t> listed_components(const Scene& scene) {
    std::vector<std::size_t> listed;
    for (std::size_t i = 0; i < scene.components.size(); ++i)
        if (scene.components[i].verdict != Verdict::rejected) listed.push_back(i);
    return listed;
}

std::optional<std::size_t> room_by_parents(const Scene& scene, const Component& component) {
    const Component* at = &component;
    // A circle of parents would be a fault of a file.
    for (std::size_t depth = 0; depth < 8; ++depth) {
        if (const auto room = find_room(scene, at->parent)) return room;
        const auto parent = find_component(scene, at->parent);
        if (!parent) return std::nullopt;
        at = &scene.components[*parent];
    }
    return std::nullopt;
}

std::string viewer_model_json(const Reconstruction& reconstruction, const GriddedPoints& points,
                              std::size_t num_shown) {
    const Building building = describe_building(reconstruction.scene);
    const PointCloud& cloud = reconstruction.map.cloud;
    const auto per_point = [&](std::size_t size) { return size > 0 && size == cloud.size(); };

    Json json;
    json["format"] = "roomscribe-view";
    json["version"] = 1;
    const Eigen::Vector3d& size = points.size_of_box;
    json["cube"] = {{"low", {points.low.x(), points.low.y(), points.low.z()}},
                    {"size", {size.x(), size.y(), size.z()}},
                    {"step", points.step}};
    json["points"] = {{"shown", num_shown},
                      {"total", cloud.size()},
                      {"labels", per_point(reconstruction.labels.labels.size())},
                      {"intensities", per_point(cloud.intensities.size())},
                      {"colors", per_point(cloud.colors.size())}};
    json["labels"] = labels_json(reconstruction);
    json["components"] = Json::array();
    for (std::size_t i = 0; i < building.scene.components.size(); ++i)
        json["components"].push_back(component_json(building, i));
    json["rooms"] = rooms_json(building.scene);
    json["scans"] = scans_json(reconstruction);
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    // Inside a script element nothing may look like its end.
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text)
        safe += c == '<' ? "\\u003c" : std::string(1, c);
    return safe;
}

}  // namespace roomscribe
