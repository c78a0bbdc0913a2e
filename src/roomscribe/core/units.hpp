// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace roomscribe {

/// Angles are radians everywhere inside; degrees appear where a human or a foreign file says them.
constexpr double radians(double degrees) {
    return degrees * (std::numbers::pi / 180.0);
}

constexpr double degrees(double radians) {
    return radians * (180.0 / std::numbers::pi);
}

}  // namespace roomscribe
