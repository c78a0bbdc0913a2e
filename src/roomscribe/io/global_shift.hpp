// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace roomscribe {

/// m, what a far coordinate is kept without (PointCloud::global_shift), in steps of 100 m; 0 for
/// one up to 1000 m, where float32 holds 0.06 mm.
inline double global_shift_of(double coordinate) {
    constexpr double largest_near_coordinate = 1000.0;
    constexpr double step = 100.0;
    return std::abs(coordinate) > largest_near_coordinate ? std::round(coordinate / step) * step
                                                          : 0.0;
}

}  // namespace roomscribe
