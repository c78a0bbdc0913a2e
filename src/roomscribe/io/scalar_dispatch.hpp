// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <type_traits>

#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

/// Calls `function` with a std::type_identity of the C++ type that `type` stands for.
template <typename Function>
decltype(auto) with_scalar_type(ScalarType type, Function&& function) {
    switch (type) {
        case ScalarType::int8:
            return function(std::type_identity<std::int8_t>());
        case ScalarType::uint8:
            return function(std::type_identity<std::uint8_t>());
        case ScalarType::int16:
            return function(std::type_identity<std::int16_t>());
        case ScalarType::uint16:
            return function(std::type_identity<std::uint16_t>());
        case ScalarType::int32:
            return function(std::type_identity<std::int32_t>());
        case ScalarType::uint32:
            return function(std::type_identity<std::uint32_t>());
        case ScalarType::int64:
            return function(std::type_identity<std::int64_t>());
        case ScalarType::uint64:
            return function(std::type_identity<std::uint64_t>());
        case ScalarType::float32:
            return function(std::type_identity<float>());
        case ScalarType::float64:
            break;
    }
    return function(std::type_identity<double>());
}

}  // namespace roomscribe
