// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_probability.hpp"

#include <cmath>

namespace roomscribe {
namespace {

double logistic(double x) {
    return 1.0 / (1.0 + std::exp(-x));
}

}  // namespace

double probability_without_rivals(const PoseStanding& standing) {
    return standing.is_exhaustive ? logistic(standing.evidence - 10.5)
                                  : logistic(0.07 * (standing.evidence - 6.7));
}

double probability_of(const PoseStanding& standing) {
    return probability_without_rivals(standing) * logistic(0.3 * (standing.lead - 6.0));
}

}  // namespace roomscribe
