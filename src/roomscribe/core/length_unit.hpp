// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace roomscribe {

/// Units in which programs write coordinates. Inside, all lengths are metres.
enum class LengthUnit : std::uint8_t { metre, millimetre, centimetre, inch, foot };

/// The short words: what `--unit` takes.
inline constexpr std::array<std::string_view, 5> length_unit_names{"m", "mm", "cm", "in", "ft"};

constexpr double metres_per(LengthUnit unit) {
    constexpr std::array<double, 5> metres{1.0, 1e-3, 1e-2, 0.0254, 0.3048};
    return metres[static_cast<std::size_t>(unit)];
}

/// "millimetres"
constexpr std::string_view length_unit_word(LengthUnit unit) {
    constexpr std::array<std::string_view, 5> words{"metres", "millimetres", "centimetres",
                                                    "inches", "feet"};
    return words[static_cast<std::size_t>(unit)];
}

constexpr std::string_view length_unit_name(LengthUnit unit) {
    return length_unit_names[static_cast<std::size_t>(unit)];
}

}  // namespace roomscribe
