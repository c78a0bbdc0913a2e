// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

/// One named property of every point of a file: `count` values of `type`.
struct Field {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t count = 1;

    std::size_t bytes() const { return size_of(type) * count; }
};

/// "float32", "uint8", ...
std::string_view scalar_type_name(ScalarType type);

}  // namespace roomscribe
