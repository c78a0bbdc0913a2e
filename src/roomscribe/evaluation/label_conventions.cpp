// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/label_conventions.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

template <typename... Labels>
constexpr LabelSet labels(Labels... each) {
    return static_cast<LabelSet>((... | label_bit(each)));
}

using L = Label;
constexpr LabelSet furniture_with_handles = labels(L::furniture, L::handle);

constexpr std::array<ForeignClass, 13> s3dis_classes{{
    {"ceiling", L::ceiling, labels(L::ceiling)},
    {"floor", L::floor, labels(L::floor)},
    {"wall", L::wall, labels(L::wall)},
    {"beam", L::unknown, labels(L::unknown, L::ceiling, L::wall)},
    {"column", L::unknown, labels(L::unknown, L::wall)},
    {"window", L::window, labels(L::window, L::window_frame)},
    {"door", L::door, labels(L::door, L::door_frame, L::handle)},
    {"table", L::furniture, furniture_with_handles},
    {"chair", L::furniture, labels(L::furniture)},
    {"sofa", L::furniture, labels(L::furniture)},
    {"bookcase", L::furniture, furniture_with_handles},
    {"board", L::unknown, labels(L::unknown)},
    // Cupboards, lamps, plants, bins: what has no class of its own.
    {"clutter", L::unknown, protocol::every_label},
}};

// Its doors and windows are points without a rectangle, their frames and handles part of them.
constexpr LabelConvention s3dis{"s3dis", s3dis_classes, protocol::instance_labels};

/// What holds things of several labels, or what our labels leave open.
constexpr ForeignClass mixed(std::string_view name) {
    return {name, L::unknown, protocol::every_label};
}
constexpr ForeignClass piece(std::string_view name) {
    return {name, L::furniture, furniture_with_handles};
}
constexpr ForeignClass thing(std::string_view name) {
    return {name, L::unknown, labels(L::unknown)};
}

constexpr std::array<ForeignClass, 41> nyu40_classes{{
    mixed("unlabelled"),
    {"wall", L::wall, labels(L::wall)},
    {"floor", L::floor, labels(L::floor)},
    piece("cabinet"),
    piece("bed"),
    piece("chair"),
    piece("sofa"),
    piece("table"),
    {"door", L::door, labels(L::door, L::door_frame, L::handle)},
    {"window", L::window, labels(L::window, L::window_frame)},
    piece("bookshelf"),
    thing("picture"),
    piece("counter"),
    // Blinds and curtains hang before the window or before the wall beside it.
    mixed("blinds"),
    piece("desk"),
    piece("shelves"),
    mixed("curtain"),
    piece("dresser"),
    // Lies on a bed or a sofa, as part of it in many scans.
    mixed("pillow"),
    thing("mirror"),
    {"floor mat", L::floor, labels(L::floor, L::unknown)},
    thing("clothes"),
    {"ceiling", L::ceiling, labels(L::ceiling)},
    mixed("books"),
    piece("refrigerator"),
    thing("television"),
    thing("paper"),
    thing("towel"),
    thing("shower curtain"),
    thing("box"),
    thing("whiteboard"),
    thing("person"),
    piece("night stand"),
    // Fixed to the building: whether they are furniture is a matter of taste.
    mixed("toilet"),
    mixed("sink"),
    thing("lamp"),
    mixed("bathtub"),
    thing("bag"),
    mixed("other structure"),
    mixed("other furniture"),
    mixed("other prop"),
}};

// Its instances are objects; walls and floors are cut where the annotators' segments happened to
// end.
constexpr LabelConvention nyu40{"nyu40", nyu40_classes, labels(L::furniture)};

constexpr ForeignClass unknown_class{"", L::unknown, protocol::every_label};

const ForeignClass& class_of(const LabelConvention& convention, std::int32_t number) {
    if (number < 0 || static_cast<std::size_t>(number) >= convention.classes.size())
        return unknown_class;
    return convention.classes[static_cast<std::size_t>(number)];
}

/// Numbers the components: a data set may count its instances anew in every class.
class ComponentTable {
  public:
    explicit ComponentTable(Scene& scene) : scene_(scene) {}

    std::int32_t number_of(const ForeignClass& foreign, std::int32_t instance) {
        const auto next = static_cast<std::int32_t>(scene_.components.size());
        const auto [entry, is_new] = numbers_.try_emplace({foreign.name, instance}, next);
        if (is_new) {
            Component& component = scene_.components.emplace_back();
            component.id = fmt::format("{}-{}", foreign.name, instance);
            component.label = foreign.label;
            component.kind = foreign.name;
            component.instance = next;
            component.confidence = 1.0;
            component.verdict = Verdict::accepted;
        }
        return entry->second;
    }

  private:
    Scene& scene_;
    std::map<std::pair<std::string_view, std::int32_t>, std::int32_t> numbers_;
};

void require_size(const char* what, std::size_t size, std::size_t expected) {
    if (size == expected) return;
    throw InvalidArgument(what, fmt::format("{} entries", size), fmt::format("{}", expected));
}

}  // namespace

std::optional<LabelConvention> find_label_convention(std::string_view name) {
    for (const LabelConvention& convention : {s3dis, nyu40})
        if (name == convention.name) return convention;
    return std::nullopt;
}

GroundTruth truth_from_labelled_cloud(ScanMap map, std::span<const std::int32_t> classes,
                                      std::span<const std::int32_t> instances,
                                      const LabelConvention& convention) {
    const std::size_t num_points = map.cloud.size();
    require_size("classes", classes.size(), num_points);
    if (!instances.empty()) require_size("instances", instances.size(), num_points);

    GroundTruth truth;
    truth.map = std::move(map);
    ComponentTable components(truth.scene);
    for (std::size_t i = 0; i < num_points; ++i) {
        const ForeignClass& foreign = class_of(convention, classes[i]);
        truth.labels.push_back(foreign.label);
        truth.acceptable.push_back(foreign.acceptable);
        const bool has_component = !instances.empty() && instances[i] >= 0 &&
                                   protocol::contains(convention.detected_labels, foreign.label);
        truth.instances.push_back(has_component ? components.number_of(foreign, instances[i]) : -1);
    }
    return truth;
}

}  // namespace roomscribe
