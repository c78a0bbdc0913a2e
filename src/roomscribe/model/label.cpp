// SPDX-License-Identifier: MIT
#include "roomscribe/model/label.hpp"

namespace roomscribe {
namespace {

struct LabelEntry {
    std::string_view name;
    std::array<std::uint8_t, 3> color;
};

constexpr std::array<LabelEntry, num_labels> labels{{
    {"unknown", {150, 150, 150}},
    {"floor", {214, 39, 40}},
    {"ceiling", {240, 200, 30}},
    {"wall", {44, 160, 44}},
    {"door_frame", {23, 190, 207}},
    {"door", {31, 80, 220}},
    {"window_frame", {148, 103, 189}},
    {"window", {140, 200, 255}},
    {"furniture", {190, 120, 60}},
    {"handle", {227, 60, 190}},
}};

}  // namespace

std::string_view label_name(Label label) {
    return labels[static_cast<std::size_t>(label)].name;
}

std::optional<Label> label_from_name(std::string_view name) {
    for (std::size_t id = 0; id < labels.size(); ++id) {
        if (labels[id].name == name) return static_cast<Label>(id);
    }
    return std::nullopt;
}

std::array<std::uint8_t, 3> label_color(Label label) {
    return labels[static_cast<std::size_t>(label)].color;
}

}  // namespace roomscribe
