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
    switch (standing.search) {
        case PoseSearch::exhaustive:
            return logistic(standing.evidence - 10.5);
        case PoseSearch::wide:
            return logistic(0.35 * (standing.evidence - 13.0));
        case PoseSearch::narrow:
            break;
    }
    return logistic(0.2 * (standing.evidence - 16.0));
}

double probability_of(const PoseStanding& standing) {
    const double alone = probability_without_rivals(standing);
    const bool is_narrow = standing.search == PoseSearch::narrow;
    // A frame that has no rival may have missed them all.
    if (!is_narrow && !standing.rival) return alone;
    const double lead = standing.evidence - standing.rival.value_or(0.0);
    return alone * (is_narrow ? logistic(0.6 * (lead - 11.0)) : logistic(0.3 * (lead - 6.0)));
}

}  // namespace roomscribe
