// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scenario_json.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> opening_kind_names{"door", "passage", "window", "niche"};
constexpr std::array<std::string_view, 3> leaf_state_names{"closed", "ajar", "open"};

std::span<const std::string_view> names_of(OpeningKind) {
    return opening_kind_names;
}
std::span<const std::string_view> names_of(LeafState) {
    return leaf_state_names;
}
std::span<const std::string_view> names_of(ScannerKind) {
    return scanner_kind_names;
}

// The fields of each part of a scenario, once for reading and writing: `io(name, field)`.

void visit(RoomPlan& room, auto&& io) {
    io("name", room.name);
    io("use", room.use);
    io("outline", room.outline);
    io("floor_height", room.floor_height);
    io("ceiling_height", room.ceiling_height);
}

void visit(OpeningPlan& opening, auto&& io) {
    io("kind", opening.kind);
    io("room", opening.room);
    io("at", opening.at);
    io("width", opening.width);
    io("height", opening.height);
    io("sill", opening.sill);
    io("frame_width", opening.frame_width);
    io("frame_protrusion", opening.frame_protrusion);
    io("recess", opening.recess);
    io("leaf", opening.leaf);
    io("leaf_angle", opening.leaf_angle);
    io("opens_into_room", opening.opens_into_room);
    io("is_hinged_left", opening.is_hinged_left);
    io("is_double", opening.is_double);
    io("is_glazed", opening.is_glazed);
    io("mullions", opening.mullions);
    io("blind", opening.blind);
    io("transparency", opening.transparency);
    io("style", opening.style);
}

void visit(ItemPlan& item, auto&& io) {
    io("kind", item.kind);
    io("at", item.at);
    io("turn", item.turn);
    io("size", item.size);
    io("elevation", item.elevation);
    io("style", item.style);
}

void visit(Station& station, auto&& io) {
    io("at", station.at);
    io("heading", station.heading);
    io("pitch", station.pitch);
    io("roll", station.roll);
}

void visit(Scenario& scenario, auto&& io) {
    io("name", scenario.name);
    io("seed", scenario.seed);
    io("outer_wall_thickness", scenario.outer_wall_thickness);
    io("storey_height", scenario.storey_height);
    io("scanner", scenario.scanner);
    io("coarseness", scenario.coarseness);
    io("rooms", scenario.rooms);
    io("openings", scenario.openings);
    io("items", scenario.items);
    io("stations", scenario.stations);
}

template <typename Value>
concept Part = std::same_as<Value, RoomPlan> || std::same_as<Value, OpeningPlan> ||
    std::same_as<Value, ItemPlan> || std::same_as<Value, Station> || std::same_as<Value, Scenario>;

template <typename Value>
concept Choice = std::is_enum_v<Value>;

/// Tenths of a millimetre and of a millidegree: more than anybody writes.
double rounded(double value) {
    return std::round(value * 1e4) / 1e4 + 0.0;
}

Json to_json(double value) {
    return rounded(value);
}
Json to_json(const std::string& value) {
    return value;
}
template <std::integral Integer>
Json to_json(Integer value) {
    return value;
}
template <Choice Enum>
Json to_json(Enum value) {
    return names_of(value)[static_cast<std::size_t>(value)];
}
template <int Size>
Json to_json(const Eigen::Matrix<double, Size, 1>& vector) {
    Json array = Json::array();
    for (const double value : vector)
        array.push_back(rounded(value));
    return array;
}
template <Part Value>
Json to_json(const Value& part);

template <typename Value>
Json to_json(const std::vector<Value>& values) {
    Json array = Json::array();
    for (const Value& value : values)
        array.push_back(to_json(value));
    return array;
}
template <Part Value>
Json to_json(const Value& part) {
    Json object = Json::object();
    Value copy = part;
    Json defaults = Json::object();
    Value untouched;
    visit(untouched, [&](const char* name, auto& field) { defaults[name] = to_json(field); });
    visit(copy, [&](const char* name, auto& field) {
        Json value = to_json(field);
        if (value != defaults[name]) object[name] = std::move(value);
    });
    return object;
}

/// Where in which file a value stands.
struct Place {
    const std::string& path;
    std::string name;

    [[noreturn]] void fail(std::string_view reason) const {
        throw IoError(path, "scenario JSON", {},
                      fmt::format("{}: {}", name.empty() ? "document" : name, reason),
                      "see docs/simulation.md");
    }
    Place inside(std::string_view key) const {
        return {path, name.empty() ? std::string(key) : fmt::format("{}.{}", name, key)};
    }
    Place inside(std::size_t index) const { return {path, fmt::format("{}[{}]", name, index)}; }
};

void read(const Json& json, const Place& place, double& value) {
    if (!json.is_number()) place.fail("must be a number");
    value = json.get<double>();
    if (!std::isfinite(value)) place.fail("must be a finite number");
}
void read(const Json& json, const Place& place, bool& value) {
    if (!json.is_boolean()) place.fail("must be true or false");
    value = json.get<bool>();
}
void read(const Json& json, const Place& place, std::string& value) {
    if (!json.is_string()) place.fail("must be a text");
    value = json.get<std::string>();
}
template <std::integral Integer>
void read(const Json& json, const Place& place, Integer& value) {
    if (!json.is_number_unsigned()) place.fail("must be a whole number, 0 or more");
    const auto number = json.get<std::uint64_t>();
    if (!std::in_range<Integer>(number)) place.fail("is too large");
    value = static_cast<Integer>(number);
}
template <Choice Enum>
void read(const Json& json, const Place& place, Enum& value) {
    std::string word;
    read(json, place, word);
    const std::span<const std::string_view> names = names_of(value);
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) {
        place.fail(fmt::format("\"{}\" is none of {}", word, fmt::join(names, ", ")));
    }
    value = static_cast<Enum>(found - names.begin());
}
template <int Size>
void read(const Json& json, const Place& place, Eigen::Matrix<double, Size, 1>& vector) {
    if (!json.is_array() || json.size() != Size)
        place.fail(fmt::format("must be {} numbers", Size));
    for (Eigen::Index i = 0; i < Size; ++i) {
        const auto index = static_cast<std::size_t>(i);
        read(json[index], place.inside(index), vector(i));
    }
}
template <Part Value>
void read(const Json& json, const Place& place, Value& part);

template <typename Value>
void read(const Json& json, const Place& place, std::vector<Value>& values) {
    if (!json.is_array()) place.fail("must be a list");
    values.clear();
    for (std::size_t i = 0; i < json.size(); ++i) {
        read(json[i], place.inside(i), values.emplace_back());
    }
}
template <Part Value>
void read(const Json& json, const Place& place, Value& part) {
    if (!json.is_object()) place.fail("must be an object");
    std::vector<std::string> known;
    visit(part, [&](const char* name, auto& field) {
        known.emplace_back(name);
        const auto found = json.find(name);
        if (found != json.end()) read(*found, place.inside(name), field);
    });
    for (const auto& [key, value] : json.items()) {
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            place.fail(fmt::format("\"{}\" is none of {}", key, fmt::join(known, ", ")));
        }
    }
}

}  // namespace

std::string scenario_to_json(const Scenario& scenario) {
    return to_json(scenario).dump(1) + "\n";
}

Scenario scenario_from_json(std::string_view text, const std::string& path) {
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::parse_error& error) {
        throw IoError(path, "scenario JSON", {.byte = error.byte}, "is not JSON",
                      "see docs/simulation.md");
    } catch (const Json::out_of_range&) {
        throw IoError(path, "scenario JSON", {}, "holds a number that no double can hold",
                      "see docs/simulation.md");
    }
    Scenario scenario;
    read(json, Place{path, ""}, scenario);
    return scenario;
}

}  // namespace roomscribe
