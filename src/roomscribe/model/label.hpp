// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace roomscribe {

/// What a point belongs to (paper, section 4.1). The ids are fixed for ever: files carry them.
enum class Label : std::uint8_t {
    unknown = 0,
    floor = 1,
    ceiling = 2,
    wall = 3,
    door_frame = 4,
    door = 5,
    window_frame = 6,
    window = 7,
    furniture = 8,
    handle = 9
};

inline constexpr std::size_t num_labels = 10;

/// Several labels: bit i stands for the label with id i.
using LabelSet = std::uint16_t;

constexpr LabelSet label_bit(Label label) {
    return static_cast<LabelSet>(1U << static_cast<unsigned>(label));
}

/// "door_frame" for Label::door_frame: the word that files and reports use.
std::string_view label_name(Label label);

std::optional<Label> label_from_name(std::string_view name);

/// Red, green, blue. The paper's colours (its Fig. 3c) where it gives one.
std::array<std::uint8_t, 3> label_color(Label label);

}  // namespace roomscribe
