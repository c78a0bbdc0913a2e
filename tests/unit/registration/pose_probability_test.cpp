// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_probability.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

constexpr std::array<PoseSearch, 3> searches{PoseSearch::narrow, PoseSearch::wide,
                                             PoseSearch::exhaustive};

double probability(double evidence, double lead, PoseSearch search) {
    return probability_of({evidence, evidence - lead, search});
}

TEST(PoseProbability, GrowsWithEvidenceLeadAndSearch) {
    for (const PoseSearch search : searches) {
        for (double evidence = 0.0; evidence < 30.0; evidence += 5.0) {
            for (double lead = 0.0; lead <= evidence; lead += 5.0) {
                const double here = probability(evidence, lead, search);
                EXPECT_LT(here, probability(evidence + 5.0, lead, search));
                EXPECT_LT(here, probability(evidence, lead + 5.0, search));
            }
        }
    }
    EXPECT_LT(probability(25.0, 25.0, PoseSearch::narrow),
              probability(25.0, 25.0, PoseSearch::wide));
}

TEST(PoseProbability, IsOneOrNoneAtTheEnds) {
    EXPECT_NEAR(probability(1e4, 1e4, PoseSearch::exhaustive), 1.0, 1e-12);
    EXPECT_NEAR(probability(1e4, 1e4, PoseSearch::narrow), 1.0, 1e-12);
    EXPECT_NEAR(probability(-1e4, -1e4, PoseSearch::exhaustive), 0.0, 1e-12);
    EXPECT_TRUE(std::isfinite(probability(-1e9, 1e9, PoseSearch::narrow)));
}

TEST(PoseProbability, EqualPosesCannotBothBeLikely) {
    for (const PoseSearch search : searches)
        EXPECT_LT(probability(1e3, 0.0, search), 0.5);
}

TEST(PoseProbability, ARivalTakesNothingFromTheEvidence) {
    const PoseStanding with_rival{30.0, 30.0, PoseSearch::exhaustive};
    EXPECT_GT(probability_without_rivals(with_rival), 0.9);
    EXPECT_LT(probability_of(with_rival), 0.5);
}

/// Corners and rows of like doors: wrong poses of two simulated depth frames lead by up to 12
/// pieces, right ones by more.
TEST(PoseProbability, FramesAskForAGreaterLead) {
    EXPECT_GT(probability(60.0, 12.0, PoseSearch::exhaustive), 0.8);
    EXPECT_LT(probability(60.0, 12.0, PoseSearch::narrow), 0.7);
    EXPECT_GT(probability(60.0, 17.0, PoseSearch::narrow), 0.95);
}

TEST(PoseProbability, WithoutARivalTheEvidenceDecidesWhereNoneWasMissed) {
    for (const PoseSearch search : {PoseSearch::wide, PoseSearch::exhaustive}) {
        const PoseStanding alone{18.0, {}, search};
        EXPECT_EQ(probability_of(alone), probability_without_rivals(alone));
    }
    const PoseStanding frames{18.0, {}, PoseSearch::narrow};
    EXPECT_LT(probability_of(frames), probability_without_rivals(frames));
}

}  // namespace
}  // namespace roomscribe
