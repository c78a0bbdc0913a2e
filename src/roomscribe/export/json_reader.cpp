// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "roomscribe/core/error.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Json = nlohmann::json;

constexpr const char* cure = "write the file with roomscribe, or see docs/formats.md";

/// What complaints call the document.
struct DocumentName {
    std::string path;
    std::string_view format;
};

/// A value in the document that knows its place, so that a complaint can name it.
class Node {
  public:
    Node(const Json& json, const DocumentName& document, std::string place = "")
        : json_(&json), document_(&document), place_(std::move(place)) {}

    [[noreturn]] void fail(std::string_view reason) const {
        throw IoError(document_->path, document_->format, {},
                      fmt::format("{}: {}", place_.empty() ? "document" : place_, reason), cure);
    }

    /// Empty where the key is absent or its value null, as other programs write what they lack.
    std::optional<Node> find(const char* key) const {
        if (!json_->is_object()) fail("must be an object");
        const auto found = json_->find(key);
        if (found == json_->end() || found->is_null()) return std::nullopt;
        return Node(*found, *document_, place_.empty() ? key : place_ + "." + key);
    }
    Node at(const char* key) const {
        std::optional<Node> node = find(key);
        if (!node) fail(fmt::format("key \"{}\" is missing", key));
        return std::move(*node);
    }
    std::vector<Node> elements() const {
        if (!json_->is_array()) fail("must be an array");
        std::vector<Node> nodes;
        for (std::size_t i = 0; i < json_->size(); ++i) {
            nodes.emplace_back((*json_)[i], *document_, fmt::format("{}[{}]", place_, i));
        }
        return nodes;
    }
    std::vector<Node> elements(std::size_t count) const {
        std::vector<Node> nodes = elements();
        if (nodes.size() != count) {
            fail(fmt::format("has {} elements instead of {}", nodes.size(), count));
        }
        return nodes;
    }

    double number() const {
        if (!json_->is_number()) fail("must be a number");
        return json_->get<double>();
    }
    template <typename Integer>
    Integer integer() const {
        const double value = number();
        const auto low = static_cast<double>(std::numeric_limits<Integer>::min());
        const auto high = static_cast<double>(std::numeric_limits<Integer>::max());
        if (!json_->is_number_integer() || value < low || value > high) {
            fail("must be a whole number in range");
        }
        return json_->get<Integer>();
    }
    bool truth() const {
        if (!json_->is_boolean()) fail("must be true or false");
        return json_->get<bool>();
    }
    std::string text() const {
        if (!json_->is_string()) fail("must be a text");
        return json_->get<std::string>();
    }

  private:
    const Json* json_;
    const DocumentName* document_;
    std::string place_;
};

void read(const Node& node, double& value) {
    value = node.number();
}
void read(const Node& node, std::optional<double>& value) {
    value = node.number();
}
void read(const Node& node, bool& value) {
    value = node.truth();
}
void read(const Node& node, std::string& value) {
    value = node.text();
}
void read(const Node& node, std::int32_t& value) {
    value = node.integer<std::int32_t>();
}
void read(const Node& node, std::uint64_t& value) {
    value = node.integer<std::uint64_t>();
}
void read(const Node& node, Eigen::Vector3d& value) {
    const std::vector<Node> elements = node.elements(3);
    value = {elements[0].number(), elements[1].number(), elements[2].number()};
}
template <typename Value>
void read(const Node& node, std::vector<Value>& values) {
    values.clear();
    for (const Node& element : node.elements())
        read(element, values.emplace_back());
}

void read(const Node& node, Label& label) {
    const std::optional<Label> known = label_from_name(node.text());
    if (!known) node.fail("\"" + node.text() + "\" is not a label");
    label = *known;
}

void read(const Node& node, Verdict& verdict) {
    for (const Verdict known : {Verdict::accepted, Verdict::doubtful, Verdict::rejected}) {
        if (verdict_name(known) != node.text()) continue;
        verdict = known;
        return;
    }
    node.fail("\"" + node.text() + "\" is not a verdict");
}

void read(const Node& node, Transform& transform) {
    const std::vector<Node> rows = node.elements(4);
    Eigen::Matrix4d matrix;
    for (Eigen::Index row = 0; row < 4; ++row) {
        const std::vector<Node> numbers = rows[static_cast<std::size_t>(row)].elements(4);
        for (Eigen::Index column = 0; column < 4; ++column) {
            matrix(row, column) = numbers[static_cast<std::size_t>(column)].number();
        }
    }
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    const bool is_rigid = (rotation.transpose() * rotation).isIdentity(1e-3) &&
                          rotation.determinant() > 0.0 &&
                          matrix.row(3).isApprox(Eigen::RowVector4d::UnitW());
    if (!is_rigid) node.fail("is not a rigid motion");
    transform.matrix() = matrix;
}

/// Leaves the value as it is where the key is absent.
template <typename Value>
void read_if_present(const Node& object, const char* key, Value& value) {
    if (const std::optional<Node> node = object.find(key)) read(*node, value);
}

void read(const Node& node, OrientedBox& box) {
    read(node.at("center"), box.center);
    read(node.at("size"), box.size);
    const std::vector<Node> axes = node.at("axes").elements(3);
    for (std::size_t i = 0; i < 3; ++i)
        read(axes[i], box.axes[i]);
}

void read(const Node& node, Grasp& grasp) {
    read_if_present(node, "position", grasp.position);
    read_if_present(node, "axis", grasp.axis);
    read_if_present(node, "approach", grasp.approach);
    read_if_present(node, "opening", grasp.opening);
}

void read(const Node& node, MotionKind& kind) {
    for (const MotionKind known : {MotionKind::hinged, MotionKind::pull}) {
        if (motion_kind_name(known) != node.text()) continue;
        kind = known;
        return;
    }
    node.fail("\"" + node.text() + "\" is no way to open");
}

void read(const Node& node, OpeningMotion& motion) {
    read(node.at("kind"), motion.kind);
    read(node.at("point"), motion.point);
    read(node.at("direction"), motion.direction);
    read_if_present(node, "confidence", motion.confidence);
}

void read(const Node& node, Evidence& evidence) {
    read_if_present(node, "rule", evidence.rule);
    read_if_present(node, "points", evidence.points);
    read_if_present(node, "scans", evidence.scans);
    read_if_present(node, "coverage", evidence.coverage);
    read_if_present(node, "occluded", evidence.occluded);
    read_if_present(node, "rms", evidence.rms);
    read_if_present(node, "alternative", evidence.alternative);
}

void read(const Node& node, Component& component) {
    read(node.at("id"), component.id);
    read(node.at("label"), component.label);
    read_if_present(node, "kind", component.kind);
    read_if_present(node, "instance", component.instance);
    read_if_present(node, "parent", component.parent);
    read_if_present(node, "polygon", component.polygon);
    if (const std::optional<Node> box = node.find("box")) read(*box, component.box.emplace());
    if (const std::optional<Node> grasp = node.find("grasp")) {
        read(*grasp, component.grasp.emplace());
    }
    if (const std::optional<Node> motion = node.find("opens")) {
        read(*motion, component.opens.emplace());
    }
    read_if_present(node, "visible", component.visible);
    read_if_present(node, "confidence", component.confidence);
    read_if_present(node, "verdict", component.verdict);
    read_if_present(node, "evidence", component.evidence);
}

void read(const Node& node, RoomNeighbor& neighbor) {
    read(node.at("room"), neighbor.room);
    read_if_present(node, "through", neighbor.through);
}

void read(const Node& node, Room& room) {
    read(node.at("id"), room.id);
    read_if_present(node, "polygon", room.polygon);
    read_if_present(node, "floor_height", room.floor_height);
    read_if_present(node, "ceiling_height", room.ceiling_height);
    read_if_present(node, "area", room.area);
    read_if_present(node, "volume", room.volume);
    read_if_present(node, "walls", room.walls);
    read_if_present(node, "neighbours", room.neighbors);
}

void read(const Node& node, LinkVerdict& verdict) {
    for (const LinkVerdict known :
         {LinkVerdict::accepted, LinkVerdict::ambiguous, LinkVerdict::rejected}) {
        if (link_verdict_name(known) != node.text()) continue;
        verdict = known;
        return;
    }
    node.fail("\"" + node.text() + "\" is not a verdict");
}

void read(const Node& node, Eigen::Matrix<double, 6, 6>& matrix) {
    const std::vector<Node> rows = node.elements(6);
    for (Eigen::Index row = 0; row < 6; ++row) {
        const std::vector<Node> numbers = rows[static_cast<std::size_t>(row)].elements(6);
        for (Eigen::Index column = 0; column < 6; ++column) {
            matrix(row, column) = numbers[static_cast<std::size_t>(column)].number();
        }
    }
}

void read(const Node& node, Eigen::Matrix<double, 6, 1>& twist) {
    const std::vector<Node> numbers = node.elements(6);
    for (Eigen::Index i = 0; i < 6; ++i)
        twist[i] = numbers[static_cast<std::size_t>(i)].number();
}

void read(const Node& node, LoopCheck& check) {
    for (const LoopCheck known :
         {LoopCheck::none, LoopCheck::agrees, LoopCheck::disagrees, LoopCheck::resolved}) {
        if (loop_check_name(known) != node.text()) continue;
        check = known;
        return;
    }
    node.fail("\"" + node.text() + "\" is not an outcome of a loop check");
}

void read(const Node& node, ScanRecord& scan) {
    read_if_present(node, "name", scan.name);
    read_if_present(node, "placed", scan.is_placed);
    read_if_present(node, "doubtful", scan.is_doubtful);
    read_if_present(node, "residual", scan.residual);
    read_if_present(node, "overlap", scan.overlap);
    if (const std::optional<Node> covariance = node.find("covariance"))
        read(*covariance, scan.covariance.emplace());
}

void read(const Node& node, RegistrationLink& link) {
    read(node.at("source"), link.source);
    read(node.at("target"), link.target);
    read(node.at("verdict"), link.verdict);
    read(node.at("target_from_source"), link.target_from_source);
    read_if_present(node, "probability", link.probability);
    read_if_present(node, "loops", link.loops);
    read_if_present(node, "overlap", link.overlap);
    read_if_present(node, "agreement", link.agreement);
    read_if_present(node, "rmse", link.rmse);
    read_if_present(node, "inliers", link.inliers);
    read_if_present(node, "covariance", link.covariance);
    read_if_present(node, "unobservable", link.unobservable);
    if (const std::optional<Node> rival = node.find("rival"))
        read(*rival, link.rivals.emplace_back());
}

void read(const Node& node, CorrectionAction& action) {
    constexpr std::array<std::string_view, 4> names{"pin", "reject", "relabel", "set_size"};
    const auto* const name = std::find(names.begin(), names.end(), node.text());
    if (name == names.end())
        node.fail("\"" + node.text() + "\" is not pin, reject, relabel or set_size");
    action = static_cast<CorrectionAction>(name - names.begin());
}

/// An element as scene.json has it; of its keys only these count.
void read_element(const Node& node, Component& element) {
    read(node.at("label"), element.label);
    read_if_present(node, "kind", element.kind);
    read_if_present(node, "parent", element.parent);
    read_if_present(node, "polygon", element.polygon);
    if (const std::optional<Node> box = node.find("box")) read(*box, element.box.emplace());
    if (const std::optional<Node> grasp = node.find("grasp")) read(*grasp, element.grasp.emplace());
    if (!element.box && element.polygon.size() < 3) node.fail("has neither a polygon nor a box");
    if (!element.box && !(area_vector(element.polygon).norm() > 0.0))
        node.fail("has a polygon without area");
}

void read(const Node& node, Correction& correction) {
    read(node.at("action"), correction.action);
    read_element(node.at("element"), correction.element);
    if (correction.action == CorrectionAction::relabel) {
        read(node.at("label"), correction.label);
        read_if_present(node, "kind", correction.kind);
    }
    if (correction.action == CorrectionAction::set_size) {
        const std::vector<Node> sizes = node.at("size").elements(correction.element.box ? 3 : 2);
        for (const Node& size : sizes) {
            correction.size.push_back(size.number());
            if (!(correction.size.back() > 0.0)) size.fail("must be greater than 0");
        }
    }
}

Json parse(std::string_view text, const DocumentName& name) {
    try {
        return Json::parse(text);
    } catch (const Json::parse_error& error) {
        throw IoError(name.path, name.format, {.byte = error.byte, .line = {}}, "is not valid JSON",
                      cure);
    } catch (const Json::out_of_range&) {
        throw IoError(name.path, name.format, {}, "holds a number that no double can hold",
                      "write it again, with finite numbers");
    }
}

void require_format(const Node& document, std::string_view format) {
    if (document.at("format").text() != format) {
        document.fail(fmt::format("format is not {}", format));
    }
    if (document.at("version").integer<int>() != 1) document.fail("version is not 1");
}

}  // namespace

Scene scene_from_json(std::string_view text, const std::string& path) {
    const DocumentName name{path, "scene JSON"};
    const Json json = parse(text, name);
    const Node document(json, name);
    require_format(document, "roomscribe-scene");

    Scene scene;
    read_if_present(document, "to_room", scene.room_from_map);
    read_if_present(document, "components", scene.components);
    read_if_present(document, "rooms", scene.rooms);
    return scene;
}

std::vector<Correction> corrections_from_json(std::string_view text, const std::string& path) {
    const DocumentName name{path, "corrections JSON"};
    const Json json = parse(text, name);
    const Node document(json, name);
    require_format(document, "roomscribe-corrections");
    std::vector<Correction> corrections;
    read(document.at("corrections"), corrections);
    return corrections;
}

RegistrationRecord registration_from_json(std::string_view text, const std::string& path) {
    const DocumentName name{path, "registration JSON"};
    const Json json = parse(text, name);
    const Node document(json, name);
    require_format(document, "roomscribe-registration");

    RegistrationRecord record;
    read(document.at("scans"), record.scans);
    const auto require_scan = [&](const Node& node, std::size_t scan) {
        if (scan < record.scans.size()) return;
        node.fail(fmt::format("names a scan that is not among the {}", record.scans.size()));
    };
    if (const std::optional<Node> components = document.find("components")) {
        for (const Node& node : components->elements()) {
            read(node, record.components.emplace_back());
            for (const std::size_t scan : record.components.back())
                require_scan(node, scan);
        }
    }
    for (const Node& node : document.at("links").elements()) {
        RegistrationLink& link = record.links.emplace_back();
        read(node, link);
        require_scan(node, std::max(link.source, link.target));
    }
    return record;
}

}  // namespace roomscribe
