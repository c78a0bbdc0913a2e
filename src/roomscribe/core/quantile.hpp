// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace roomscribe {

/// The value that a share of the others, from 0 to 1, does not exceed; 0 of none. No value may be
/// NaN. Reorders the values.
template <typename Value>
Value quantile(std::span<Value> values, double share) {
    if (values.empty()) return Value{};
    const auto rank = std::lround(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

template <typename Value>
Value quantile(std::vector<Value>& values, double share) {
    return quantile(std::span<Value>(values), share);
}

/// The upper one of an even number.
template <typename Value>
Value median(std::vector<Value>& values) {
    return quantile(values, 0.5);
}

}  // namespace roomscribe
