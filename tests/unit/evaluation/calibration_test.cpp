// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/calibration.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

DetectionMatch detection(DetectionOutcome outcome, double confidence,
                         Verdict verdict = Verdict::accepted) {
    DetectionMatch match;
    match.label = Label::door;
    match.outcome = outcome;
    match.confidence = confidence;
    match.verdict = verdict;
    return match;
}

TEST(Calibration, ErrorIsTheMeanGapBetweenConfidenceAndTruth) {
    using enum DetectionOutcome;
    const std::vector<DetectionMatch> matches{
        detection(correct, 0.95),        detection(correct, 0.97),
        detection(false_positive, 0.93), detection(correct, 0.25, Verdict::doubtful),
        detection(missed, 0.0),          detection(ignored, 0.5)};
    const Calibration calibration = calibrate(matches);
    EXPECT_EQ(calibration.bins[9].detections, 3U);
    EXPECT_EQ(calibration.bins[9].correct, 2U);
    EXPECT_NEAR(*calibration.bins[9].mean_confidence(), 0.95, 1e-12);
    EXPECT_NEAR(*calibration.bins[9].correct_share(), 2.0 / 3.0, 1e-12);
    EXPECT_EQ(calibration.bins[2].detections, 1U);
    EXPECT_EQ(calibration.bins[0].detections, 0U);
    EXPECT_FALSE(calibration.bins[0].correct_share());
    // (3 * |0.95 - 2/3| + 1 * |0.25 - 1|) / 4
    EXPECT_NEAR(*calibration.expected_error(), (2.85 - 2.0 + 0.75) / 4.0, 1e-12);
    EXPECT_EQ(calibration.accepted.detections, 3U);
    EXPECT_EQ(calibration.accepted.correct, 2U);
    EXPECT_EQ(calibration.doubtful.detections, 1U);
    Calibration twice = calibration;
    twice += calibration;
    EXPECT_EQ(twice.bins[9].detections, 6U);
    EXPECT_NEAR(*twice.expected_error(), *calibration.expected_error(), 1e-12);
}

TEST(Calibration, HasAPlaceForEveryConfidence) {
    using enum DetectionOutcome;
    const std::vector<DetectionMatch> matches{detection(correct, 0.0), detection(correct, 1.0),
                                              detection(correct, 0.1), detection(correct, -1.0),
                                              detection(correct, 7.0)};
    const Calibration calibration = calibrate(matches);
    EXPECT_EQ(calibration.bins[0].detections, 2U);
    EXPECT_EQ(calibration.bins[1].detections, 1U);
    EXPECT_EQ(calibration.bins[9].detections, 2U);
    EXPECT_FALSE(calibrate({}).expected_error());
}

}  // namespace
}  // namespace roomscribe
