// SPDX-License-Identifier: MIT
#include "roomscribe/export/json.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "roomscribe/core/error.hpp"
#include "roomscribe/export/rounding.hpp"

namespace roomscribe {
namespace {

// Keys come out in the order in which they were put in.
using Json = nlohmann::ordered_json;

constexpr double length_digits = 1e6;
constexpr double direction_digits = 1e9;

double length(double value) {
    return rounded(value, length_digits);
}

/// Six significant digits: variances lie orders of magnitude below any fixed step.
double significant(double value) {
    if (value == 0.0) return 0.0;
    const double digits = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(value))));
    return rounded(value, digits);
}

Json matrix_of(const Transform& transform) {
    Json rows = Json::array();
    for (Eigen::Index row = 0; row < 3; ++row) {
        std::vector<double> numbers_of_row = rounded(transform.linear().row(row), direction_digits);
        numbers_of_row.push_back(length(transform.translation()(row)));
        rows.push_back(std::move(numbers_of_row));
    }
    rows.push_back({0.0, 0.0, 0.0, 1.0});
    return rows;
}

Json polygon_of(const std::vector<Eigen::Vector3d>& corners) {
    Json polygon = Json::array();
    for (const Eigen::Vector3d& corner : corners)
        polygon.push_back(rounded(corner, length_digits));
    return polygon;
}

Json box_of(const OrientedBox& box) {
    Json axes = Json::array();
    for (const Eigen::Vector3d& axis : box.axes)
        axes.push_back(rounded(axis, direction_digits));
    return {{"center", rounded(box.center, length_digits)},
            {"axes", std::move(axes)},
            {"size", rounded(box.size, length_digits)}};
}

Json grasp_of(const Grasp& grasp) {
    return {{"position", rounded(grasp.position, length_digits)},
            {"axis", rounded(grasp.axis, direction_digits)},
            {"approach", rounded(grasp.approach, direction_digits)},
            {"opening", length(grasp.opening)}};
}

Json motion_of(const OpeningMotion& motion) {
    return {{"kind", motion_kind_name(motion.kind)},
            {"point", rounded(motion.point, length_digits)},
            {"direction", rounded(motion.direction, direction_digits)},
            {"confidence", length(motion.confidence)}};
}

void put_text(Json& object, const char* key, const std::string& text) {
    if (!text.empty()) object[key] = text;
}

void put_number(Json& object, const char* key, const std::optional<double>& value) {
    if (value) object[key] = length(*value);
}

Json evidence_of(const Evidence& evidence) {
    Json json = Json::object();
    put_text(json, "rule", evidence.rule);
    json["points"] = evidence.points;
    if (evidence.scans > 0) json["scans"] = evidence.scans;
    put_number(json, "coverage", evidence.coverage);
    put_number(json, "occluded", evidence.occluded);
    put_number(json, "rms", evidence.rms);
    put_text(json, "alternative", evidence.alternative);
    return json;
}

Json component_of(const Component& component) {
    Json json = {{"id", component.id}, {"label", label_name(component.label)}};
    put_text(json, "kind", component.kind);
    json["instance"] = component.instance;
    put_text(json, "parent", component.parent);
    if (!component.polygon.empty()) json["polygon"] = polygon_of(component.polygon);
    if (component.box) json["box"] = box_of(*component.box);
    if (component.grasp) json["grasp"] = grasp_of(*component.grasp);
    if (component.opens) json["opens"] = motion_of(*component.opens);
    put_number(json, "visible", component.visible);
    json["confidence"] = length(component.confidence);
    json["verdict"] = verdict_name(component.verdict);
    json["evidence"] = evidence_of(component.evidence);
    return json;
}

Json room_of(const Room& room) {
    Json json = {{"id", room.id}};
    if (!room.polygon.empty()) json["polygon"] = polygon_of(room.polygon);
    json["floor_height"] = length(room.floor_height);
    json["ceiling_height"] = length(room.ceiling_height);
    json["area"] = length(room.area);
    json["volume"] = length(room.volume);
    if (!room.walls.empty()) json["walls"] = room.walls;
    for (const RoomNeighbor& neighbor : room.neighbors) {
        Json entry = {{"room", neighbor.room}};
        put_text(entry, "through", neighbor.through);
        json["neighbours"].push_back(std::move(entry));
    }
    return json;
}

Json covariance_of(const Eigen::Matrix<double, 6, 6>& covariance) {
    Json rows = Json::array();
    for (Eigen::Index row = 0; row < 6; ++row) {
        Json numbers_of_row = Json::array();
        for (Eigen::Index column = 0; column < 6; ++column) {
            numbers_of_row.push_back(significant(covariance(row, column)));
        }
        rows.push_back(std::move(numbers_of_row));
    }
    return rows;
}

Json link_of(const RegistrationLink& link) {
    Json json = {{"source", link.source},
                 {"target", link.target},
                 {"verdict", link_verdict_name(link.verdict)},
                 {"probability", length(link.probability)},
                 {"loops", loop_check_name(link.loops)},
                 {"overlap", length(link.overlap)},
                 {"agreement", length(link.agreement)},
                 {"rmse", length(link.rmse)},
                 {"inliers", link.inliers},
                 {"target_from_source", matrix_of(link.target_from_source)},
                 {"covariance", covariance_of(link.covariance)}};
    Json unobservable = Json::array();
    for (const auto& twist : link.unobservable) {
        unobservable.push_back(rounded(twist, direction_digits));
    }
    json["unobservable"] = std::move(unobservable);
    if (!link.rivals.empty()) json["rival"] = matrix_of(link.rivals.front());
    json["stop_reason"] = link.stop_reason;
    return json;
}

/// File names may hold bytes that are not UTF-8; they must not stop a run at its end.
std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void lay_out(const Json& json, std::size_t depth, std::string& text) {
    const bool is_flat = std::none_of(json.begin(), json.end(),
                                      [](const Json& element) { return element.is_structured(); });
    if (!json.is_structured() || json.empty()) {
        text += text_of(json);
        return;
    }
    const bool on_one_line = json.is_array() && is_flat;
    const auto break_line = [&](std::size_t level) {
        if (on_one_line) return;
        text += '\n';
        text.append(2 * level, ' ');
    };
    text += json.is_array() ? '[' : '{';
    bool first = true;
    for (const auto& [key, element] : json.items()) {
        if (!first) text += on_one_line ? ", " : ",";
        first = false;
        break_line(depth + 1);
        if (json.is_object()) text.append(text_of(Json(key))).append(": ");
        lay_out(element, depth + 1, text);
    }
    break_line(depth);
    text += json.is_array() ? ']' : '}';
}

std::string laid_out(const Json& json) {
    std::string text;
    lay_out(json, 0, text);
    return text + "\n";
}

}  // namespace

std::string scene_to_json(const Scene& scene) {
    Json json = {{"format", "roomscribe-scene"},
                 {"version", 1},
                 {"units", "m"},
                 {"to_room", matrix_of(scene.room_from_map)},
                 {"components", Json::array()},
                 {"rooms", Json::array()}};
    for (const Component& component : scene.components) {
        if (component.verdict == Verdict::rejected) continue;
        json["components"].push_back(component_of(component));
    }
    for (const Room& room : scene.rooms)
        json["rooms"].push_back(room_of(room));
    return laid_out(json);
}

std::string registration_to_json(const Registration& registration,
                                 std::span<const std::string> scan_names) {
    if (scan_names.size() != registration.map_from_scan.size()) {
        throw InvalidArgument("scan_names", std::to_string(scan_names.size()) + " names",
                              "one name per scan");
    }
    Json json = {{"format", "roomscribe-registration"},
                 {"version", 1},
                 {"units", "m"},
                 {"scans", Json::array()},
                 {"components", registration.components},
                 {"links", Json::array()}};
    for (std::size_t i = 0; i < scan_names.size(); ++i) {
        const bool has_residual =
            i < registration.residuals.size() && std::isfinite(registration.residuals[i]);
        const bool placed = registration.map_from_scan[i].has_value();
        Json scan = {{"name", scan_names[i]},
                     {"placed", placed},
                     {"residual", has_residual ? Json(length(registration.residuals[i])) : Json()}};
        if (i < registration.overlaps.size()) scan["overlap"] = length(registration.overlaps[i]);
        if (i < registration.is_doubtful.size())
            scan["doubtful"] = bool{registration.is_doubtful[i]};
        if (placed && i < registration.covariances.size()) {
            scan["covariance"] = covariance_of(registration.covariances[i]);
        }
        json["scans"].push_back(std::move(scan));
    }
    for (const RegistrationLink& link : registration.links)
        json["links"].push_back(link_of(link));
    return laid_out(json);
}

std::string lay_out_json(std::string_view text) {
    Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        throw InvalidArgument("text", std::string(text.substr(0, 40)), "JSON");
    }
    return laid_out(json);
}

}  // namespace roomscribe
