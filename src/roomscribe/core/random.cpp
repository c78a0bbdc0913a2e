// SPDX-License-Identifier: MIT
#include "roomscribe/core/random.hpp"

#include <cmath>
#include <numbers>

namespace roomscribe {

double Random::normal() {
    // Box-Muller; 1 - uniform() lies in (0, 1], where the logarithm is finite.
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace roomscribe
