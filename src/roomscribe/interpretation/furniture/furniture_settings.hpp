// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "roomscribe/core/settings.hpp"
#include "roomscribe/interpretation/furniture/algorithm_5_surfaces.hpp"

namespace roomscribe {

/// How furniture is found.
enum class FurnitureMethod : std::uint8_t {
    pieces,       ///< whole pieces with their faces
    algorithm_5,  ///< the paper's: clusters on planes along the room's axes
};

inline std::span<const std::string_view> enumerator_names(FurnitureMethod) {
    static constexpr std::array<std::string_view, 2> names{"default", "algorithm_5"};
    return names;
}

struct FurnitureSettings {
    FurnitureMethod method = FurnitureMethod::pieces;
    FurnitureSurfaceSettings algorithm_5;

    void visit(SettingVisitor& visitor) {
        visitor(method, {.name = "method",
                         .unit = "",
                         .doc = "Whole pieces with their faces, or the surfaces of the paper's "
                                "Algorithm 5."});
        visitor.group("algorithm_5", algorithm_5);
    }
};

}  // namespace roomscribe
