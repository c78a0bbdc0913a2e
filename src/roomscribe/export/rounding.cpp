// SPDX-License-Identifier: MIT
#include "roomscribe/export/rounding.hpp"

#include <cmath>
#include <string>

#include "roomscribe/core/error.hpp"

namespace roomscribe {

double rounded(double value, double steps) {
    if (!std::isfinite(value)) {
        throw InvalidArgument("a number for JSON", std::to_string(value), "a finite number");
    }
    return std::round(value * steps) / steps + 0.0;  // -0 becomes 0
}

}  // namespace roomscribe
