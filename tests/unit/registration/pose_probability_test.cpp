// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_probability.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

double probability(double evidence, double lead, bool is_exhaustive) {
    return probability_of({evidence, lead, is_exhaustive});
}

TEST(PoseProbability, GrowsWithEvidenceLeadAndSearch) {
    for (const bool is_exhaustive : {false, true}) {
        for (double evidence = 0.0; evidence < 30.0; evidence += 5.0) {
            for (double lead = 0.0; lead <= evidence; lead += 5.0) {
                const double here = probability(evidence, lead, is_exhaustive);
                EXPECT_LT(here, probability(evidence + 5.0, lead, is_exhaustive));
                EXPECT_LT(here, probability(evidence, lead + 5.0, is_exhaustive));
            }
        }
    }
    EXPECT_LT(probability(25.0, 25.0, false), probability(25.0, 25.0, true));
}

TEST(PoseProbability, IsOneOrNoneAtTheEnds) {
    EXPECT_NEAR(probability(1e4, 1e4, true), 1.0, 1e-12);
    EXPECT_NEAR(probability(1e4, 1e4, false), 1.0, 1e-12);
    EXPECT_NEAR(probability(-1e4, -1e4, true), 0.0, 1e-12);
    EXPECT_TRUE(std::isfinite(probability(-1e9, 1e9, false)));
}

TEST(PoseProbability, EqualPosesCannotBothBeLikely) {
    for (const bool is_exhaustive : {false, true})
        EXPECT_LT(probability(1e3, 0.0, is_exhaustive), 0.5);
}

TEST(PoseProbability, ARivalTakesNothingFromTheEvidence) {
    const PoseStanding with_rival{30.0, 0.0, true};
    EXPECT_GT(probability_without_rivals(with_rival), 0.9);
    EXPECT_LT(probability_of(with_rival), 0.5);
}

}  // namespace
}  // namespace roomscribe
