// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

std::string_view scalar_type_name(ScalarType type) {
    switch (type) {
        case ScalarType::int8:
            return "int8";
        case ScalarType::uint8:
            return "uint8";
        case ScalarType::int16:
            return "int16";
        case ScalarType::uint16:
            return "uint16";
        case ScalarType::int32:
            return "int32";
        case ScalarType::uint32:
            return "uint32";
        case ScalarType::int64:
            return "int64";
        case ScalarType::uint64:
            return "uint64";
        case ScalarType::float32:
            return "float32";
        case ScalarType::float64:
            return "float64";
    }
    return "unknown";
}

}  // namespace roomscribe
