// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

namespace roomscribe {

/// How much a residual counts, by its size in standard deviations (Zhang 1997, "Parameter
/// estimation techniques"; constants for 95 % efficiency on normal residuals).
enum class RobustKernel : std::uint8_t {
    none,    ///< least squares
    huber,   ///< full weight up to 1.345, then falling as 1 / residual
    tukey,   ///< biweight: no weight at all beyond 4.685
    cauchy,  ///< 1 / (1 + (residual / 2.385)^2)
};

inline std::span<const std::string_view> enumerator_names(RobustKernel) {
    static constexpr std::array<std::string_view, 4> names{"none", "huber", "tukey", "cauchy"};
    return names;
}

/// Weight in [0, 1] of a residual in units of its standard deviation: psi(x) / x of the kernel.
inline double robust_weight(RobustKernel kernel, double x) {
    constexpr double huber = 1.345;
    constexpr double tukey = 4.685;
    constexpr double cauchy = 2.385;
    const double size = std::abs(x);
    switch (kernel) {
        case RobustKernel::none:
            return 1.0;
        case RobustKernel::huber:
            return size <= huber ? 1.0 : huber / size;
        case RobustKernel::tukey: {
            const double rest = 1.0 - (size / tukey) * (size / tukey);
            return rest > 0.0 ? rest * rest : 0.0;
        }
        case RobustKernel::cauchy:
            return 1.0 / (1.0 + (size / cauchy) * (size / cauchy));
    }
    return 1.0;
}

/// Standard deviation of normal residuals from the median of their absolute values.
inline constexpr double deviation_per_median = 1.4826;

}  // namespace roomscribe
