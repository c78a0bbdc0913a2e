// SPDX-License-Identifier: MIT
#include "cli/explain_scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "cli/component_facts.hpp"
#include "cli/text_table.hpp"

namespace roomscribe::cli {
namespace {

using Json = nlohmann::ordered_json;

/// "door frame", "drawer (furniture)"
std::string name_of(const Component& component) {
    std::string label(label_name(component.label));
    std::replace(label.begin(), label.end(), '_', ' ');
    if (component.kind.empty()) return label;
    std::string kind = component.kind;
    std::replace(kind.begin(), kind.end(), '_', ' ');
    return component.label == Label::unknown ? kind : fmt::format("{} ({})", kind, label);
}

std::string size_text(const ComponentFacts& facts) {
    if (!facts.extent) return "";
    const Extent& extent = *facts.extent;
    if (facts.component->box) {
        return fmt::format("{} wide, {} deep, {} high", length_text(extent.width),
                           length_text(extent.depth.value_or(0.0)), length_text(extent.height));
    }
    if (extent.is_level) {
        return fmt::format("{:.2f} m2, {} x {} overall", extent.area.value_or(0.0),
                           length_text(extent.width), length_text(extent.height));
    }
    return fmt::format("{} wide, {} high", length_text(extent.width), length_text(extent.height));
}

std::vector<std::string> ids_of(const std::vector<const Component*>& components) {
    std::vector<std::string> ids;
    ids.reserve(components.size());
    for (const Component* component : components)
        ids.push_back(component->id);
    return ids;
}

/// "on drawer-3 of furniture-2 in room-1"
std::string place_text(const ComponentFacts& facts) {
    std::string text;
    for (std::size_t i = 0; i < facts.parents.size(); ++i)
        text += fmt::format("{}{}", i == 0 ? "on " : " of ", facts.parents[i]->id);
    if (facts.room != nullptr)
        text += fmt::format("{}in {}", text.empty() ? "" : " ", facts.room->id);
    if (text.empty() && !facts.component->parent.empty())
        text = fmt::format("part of {}, which is not listed", facts.component->parent);
    return text;
}

bool stands_on_something(const ComponentFacts& facts) {
    return facts.component->label != Label::floor && facts.above_floor.has_value();
}

std::vector<std::string> where_texts(const ComponentFacts& facts) {
    std::vector<std::string> texts;
    if (std::string place = place_text(facts); !place.empty()) texts.push_back(std::move(place));
    if (stands_on_something(facts)) {
        // What is wrong by less than a millimetre stands on the floor.
        const bool on_floor = std::abs(*facts.above_floor) < 0.001;
        texts.push_back(on_floor ? "down to the floor"
                                 : fmt::format("lower edge {} {} the floor",
                                               length_text(std::abs(*facts.above_floor)),
                                               *facts.above_floor > 0.0 ? "above" : "below"));
    }
    if (facts.to_wall_ends) {
        texts.push_back(fmt::format("{} and {} from the ends of the wall",
                                    length_text((*facts.to_wall_ends)[0]),
                                    length_text((*facts.to_wall_ends)[1])));
    }
    if (facts.center) {
        texts.push_back(fmt::format("middle at x {:.2f}, y {:.2f}, z {:.2f} m in the room frame",
                                    facts.center->x(), facts.center->y(), facts.center->z()));
    }
    return texts;
}

/// What kept the rays away leaves room for the rival reading.
constexpr double much_hidden = 0.3;

std::string seen_text(const Evidence& evidence) {
    std::vector<std::string> texts;
    if (evidence.coverage) texts.push_back(share_text(*evidence.coverage) + " of it");
    if (evidence.occluded)
        texts.push_back(
            fmt::format("{} hidden from every scanner", share_text(*evidence.occluded)));
    return fmt::format("{}", fmt::join(texts, ", "));
}

std::string points_text(const Evidence& evidence) {
    if (evidence.points == 0) return "none of its own";
    if (evidence.scans == 0) return fmt::format("{}", evidence.points);
    return fmt::format("{} from {} scan{}", evidence.points, evidence.scans,
                       evidence.scans == 1 ? "" : "s");
}

std::vector<std::string> rival_texts(const Component& component) {
    const Evidence& evidence = component.evidence;
    if (evidence.alternative.empty()) return {"none that fits what was seen"};
    std::vector<std::string> texts{evidence.alternative};
    if (!evidence.rule.empty()) texts.push_back("against it: " + evidence.rule);
    if (evidence.occluded.value_or(0.0) >= much_hidden)
        texts.emplace_back("a scan of what is hidden would decide");
    return texts;
}

std::string grasp_text(const Grasp& grasp) {
    return fmt::format(
        "open the fingers {} and close them along ({:.2f}, {:.2f}, {:.2f}); move in "
        "along ({:.2f}, {:.2f}, {:.2f}), map frame",
        length_text(grasp.opening), grasp.axis.x(), grasp.axis.y(), grasp.axis.z(),
        grasp.approach.x(), grasp.approach.y(), grasp.approach.z());
}

std::vector<double> numbers(const Eigen::Vector3d& vector) {
    return {vector.x(), vector.y(), vector.z()};
}

Json extent_json(const Extent& extent) {
    Json json{{"width", extent.width}, {extent.is_level ? "length" : "height", extent.height}};
    if (extent.depth) json["depth"] = *extent.depth;
    if (extent.area) json["area"] = *extent.area;
    return json;
}

Json evidence_json(const Evidence& evidence) {
    Json json{{"rule", evidence.rule}, {"points", evidence.points}};
    if (evidence.scans > 0) json["scans"] = evidence.scans;
    if (evidence.coverage) json["coverage"] = *evidence.coverage;
    if (evidence.occluded) json["occluded"] = *evidence.occluded;
    if (evidence.rms) json["rms"] = *evidence.rms;
    if (!evidence.alternative.empty()) json["alternative"] = evidence.alternative;
    return json;
}

Json facts_json(const ComponentFacts& facts) {
    const Component& component = *facts.component;
    Json json{{"id", component.id}, {"label", label_name(component.label)}};
    if (!component.kind.empty()) json["kind"] = component.kind;
    json["verdict"] = verdict_name(component.verdict);
    json["confidence"] = component.confidence;
    if (facts.extent) json["size"] = extent_json(*facts.extent);
    if (facts.room != nullptr) json["room"] = facts.room->id;
    if (!facts.parents.empty()) json["parents"] = ids_of(facts.parents);
    if (stands_on_something(facts)) json["above_floor"] = *facts.above_floor;
    if (facts.to_wall_ends) json["to_wall_ends"] = *facts.to_wall_ends;
    if (facts.center) json["center"] = numbers(*facts.center);
    if (facts.counterpart != nullptr) {
        const bool is_frame =
            component.label == Label::door_frame || component.label == Label::window_frame;
        json[is_frame ? "around" : "frame"] = facts.counterpart->id;
    }
    if (!facts.joins.empty()) json["joins"] = facts.joins;
    if (!facts.parts.empty()) json["parts"] = ids_of(facts.parts);
    if (component.grasp) {
        json["grasp"] = {{"position", numbers(component.grasp->position)},
                         {"axis", numbers(component.grasp->axis)},
                         {"approach", numbers(component.grasp->approach)},
                         {"opening", component.grasp->opening}};
    }
    json["evidence"] = evidence_json(component.evidence);
    return json;
}

/// Collects lines; what has several texts has its topic on the first.
class LineList {
  public:
    void add(const char* topic, const std::string& words) {
        if (!words.empty()) lines_.push_back({topic, words});
    }
    void add(const char* topic, const std::vector<std::string>& texts) {
        for (std::size_t i = 0; i < texts.size(); ++i)
            lines_.push_back({i == 0 ? topic : "", texts[i]});
    }
    std::vector<std::array<std::string, 2>> take() && { return std::move(lines_); }

  private:
    std::vector<std::array<std::string, 2>> lines_;
};

std::vector<const Component*> components_in(const Scene& scene, const Room& room, Label label) {
    std::vector<const Component*> found;
    for (const Component& component : scene.components) {
        if (component.label != label || component.verdict == Verdict::rejected) continue;
        if (gather_facts(scene, component).room == &room) found.push_back(&component);
    }
    return found;
}

std::string neighbor_text(const RoomNeighbor& neighbor) {
    return neighbor.through.empty() ? neighbor.room
                                    : fmt::format("{} through {}", neighbor.room, neighbor.through);
}

std::string room_size_text(const Room& room) {
    return fmt::format("{:.2f} m2, {} high, {:.1f} m3", room.area,
                       length_text(room.ceiling_height - room.floor_height), room.volume);
}

}  // namespace

Explanation explain_component(const Scene& scene, const Component& component) {
    const ComponentFacts facts = gather_facts(scene, component);
    const Evidence& evidence = component.evidence;
    Explanation explanation;
    const std::string size = size_text(facts);
    explanation.title =
        fmt::format("{}: {}{}{}", component.id, name_of(component), size.empty() ? "" : ", ", size);
    LineList lines;
    lines.add("where", where_texts(facts));
    lines.add("verdict", fmt::format("{}, confidence {:.2f}", verdict_name(component.verdict),
                                     component.confidence));
    lines.add("because", evidence.rule);
    lines.add("seen", seen_text(evidence));
    if (evidence.rms) lines.add("residual", length_text(*evidence.rms));
    lines.add("points", points_text(evidence));
    lines.add("rival", rival_texts(component));
    lines.add("joins", joined(facts.joins));
    if (facts.counterpart != nullptr) {
        const bool is_frame =
            component.label == Label::door_frame || component.label == Label::window_frame;
        lines.add(is_frame ? "around" : "frame", facts.counterpart->id);
    }
    if (component.grasp) lines.add("grasp", grasp_text(*component.grasp));
    lines.add("carries", joined(ids_of(facts.parts)));
    explanation.lines = std::move(lines).take();
    explanation.facts = facts_json(facts);
    return explanation;
}

Explanation explain_room(const Scene& scene, const Room& room) {
    Explanation explanation;
    explanation.title = fmt::format("{}: room, {}", room.id, room_size_text(room));
    explanation.facts = {{"id", room.id},
                         {"label", "room"},
                         {"area", room.area},
                         {"height", room.ceiling_height - room.floor_height},
                         {"volume", room.volume},
                         {"floor_height", room.floor_height},
                         {"corners", room.polygon.size()}};
    LineList lines;
    lines.add("outline",
              fmt::format("{} corners, {}", room.polygon.size(),
                          std::abs(room.floor_height) < 0.001
                              ? "on the lowest floor"
                              : fmt::format("floor {} {} the lowest",
                                            length_text(std::abs(room.floor_height)),
                                            room.floor_height > 0.0 ? "above" : "below")));
    for (std::size_t id = 1; id < num_labels; ++id) {
        const auto label = static_cast<Label>(id);
        const std::vector<const Component*> found = components_in(scene, room, label);
        if (found.empty()) continue;
        const std::string name(label_name(label));
        explanation.facts[name] = ids_of(found);
        lines.add(name.c_str(), joined(ids_of(found)));
    }
    std::vector<std::string> neighbors;
    Json neighbor_facts = Json::array();
    for (const RoomNeighbor& neighbor : room.neighbors) {
        neighbors.push_back(neighbor_text(neighbor));
        neighbor_facts.push_back({{"room", neighbor.room}, {"through", neighbor.through}});
    }
    lines.add("leads to", joined(neighbors));
    explanation.facts["neighbours"] = std::move(neighbor_facts);
    explanation.lines = std::move(lines).take();
    return explanation;
}

std::string scene_table(const Scene& scene) {
    TextTable table("lllrl");
    table.add_row({"id", "what", "verdict", "sure", "where, and what else it may be"});
    for (const Room& room : scene.rooms) {
        std::vector<std::string> neighbors;
        for (const RoomNeighbor& neighbor : room.neighbors)
            neighbors.push_back(neighbor.room);
        std::sort(neighbors.begin(), neighbors.end());
        neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
        table.add_row({room.id, "room, " + room_size_text(room), "", "",
                       neighbors.empty() ? "" : "leads to " + joined(neighbors)});
    }
    for (const Component& component : scene.components) {
        if (component.verdict == Verdict::rejected) continue;
        const ComponentFacts facts = gather_facts(scene, component);
        const std::string size = size_text(facts);
        std::string where = place_text(facts);
        const std::string& rival = component.evidence.alternative;
        if (!rival.empty()) where += fmt::format("{}or {}", where.empty() ? "" : "; ", rival);
        table.add_row({component.id,
                       fmt::format("{}{}{}", name_of(component), size.empty() ? "" : ", ", size),
                       std::string(verdict_name(component.verdict)),
                       share_text(component.confidence), where});
    }
    return table.to_text();
}

}  // namespace roomscribe::cli
