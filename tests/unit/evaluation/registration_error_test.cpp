// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/registration_error.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "block_scene.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

Transform shift(double x, double y = 0.0, double z = 0.0) {
    return Transform(Eigen::Translation3d(x, y, z));
}

Transform turn(double angle) {
    return Transform(Eigen::AngleAxisd(radians(angle), Eigen::Vector3d(1, 2, 2) / 3.0));
}

/// Truth of `count` scans at random poses.
GroundTruth truth_of_scans(std::size_t count, std::uint64_t seed = 1) {
    Random random(seed);
    GroundTruth truth;
    for (std::size_t i = 0; i < count; ++i)
        truth.map_from_scan.push_back(test::random_transform(random, 10.0));
    return truth;
}

/// A result in the frame of its first scan, scan i being off by `off[i]` in its own frame.
Prediction result_off_by(const GroundTruth& truth, const std::vector<Transform>& off) {
    Prediction prediction;
    for (std::size_t i = 0; i < off.size(); ++i) {
        prediction.map_from_scan.emplace_back(truth.map_from_scan[0].inverse() *
                                              truth.map_from_scan[i] * off[i]);
    }
    return prediction;
}

TEST(RegistrationError, IsThatOfEachPoseInTheFrameOfTheFirst) {
    const GroundTruth truth = truth_of_scans(4);
    const Prediction prediction =
        result_off_by(truth, {shift(0), shift(0.03, 0.04), turn(2.0), shift(0.2) * turn(-4.0)});
    const RegistrationError error = evaluate_registration(truth, prediction);
    EXPECT_EQ(error.anchor, 0U);
    ASSERT_EQ(error.scans.size(), 3U);
    EXPECT_EQ(error.scans[0].scan, 1U);
    EXPECT_NEAR(error.scans[0].error->translation, 0.05, 1e-9);
    EXPECT_NEAR(degrees(error.scans[0].error->rotation), 0.0, 1e-6);
    EXPECT_NEAR(error.scans[1].error->translation, 0.0, 1e-9);
    EXPECT_NEAR(degrees(error.scans[1].error->rotation), 2.0, 1e-6);
    EXPECT_NEAR(error.scans[2].error->translation, 0.2, 1e-9);
    EXPECT_NEAR(degrees(error.scans[2].error->rotation), 4.0, 1e-6);
    EXPECT_NEAR(*translation_rmse(error.scans), std::sqrt((0.05 * 0.05 + 0.2 * 0.2) / 3.0), 1e-9);
    EXPECT_NEAR(*registration_recall(error.scans, protocol::strict_pose), 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(*registration_recall(error.scans, protocol::loose_pose), 1.0, 1e-12);
}

TEST(RegistrationError, RecallEndsAtItsLimits) {
    const GroundTruth truth = truth_of_scans(2);
    const auto recall = [&](const Transform& off, const protocol::PoseTolerance& tolerance) {
        const auto error = evaluate_registration(truth, result_off_by(truth, {shift(0), off}));
        return *registration_recall(error.scans, tolerance);
    };
    EXPECT_EQ(recall(shift(0.1), protocol::strict_pose), 1.0);
    EXPECT_EQ(recall(shift(0.1001), protocol::strict_pose), 0.0);
    EXPECT_EQ(recall(turn(0.999), protocol::strict_pose), 1.0);
    EXPECT_EQ(recall(turn(1.001), protocol::strict_pose), 0.0);
    EXPECT_EQ(recall(shift(0.3), protocol::loose_pose), 1.0);
    EXPECT_EQ(recall(shift(0.3001), protocol::loose_pose), 0.0);
    EXPECT_EQ(recall(turn(5.001), protocol::loose_pose), 0.0);
}

TEST(RegistrationError, CountsUnplacedScansAsMissed) {
    const GroundTruth truth = truth_of_scans(3);
    Prediction prediction = result_off_by(truth, {shift(0), shift(0.02), shift(0.05)});
    prediction.map_from_scan[1].reset();
    RegistrationError error = evaluate_registration(truth, prediction);
    EXPECT_FALSE(error.scans[0].error);
    EXPECT_EQ(registration_recall(error.scans, protocol::loose_pose), 0.5);
    EXPECT_NEAR(*translation_rmse(error.scans), 0.05, 1e-9);
    // Without the first scan, the second is the anchor.
    prediction = result_off_by(truth, {shift(0), shift(0.02), shift(0.05)});
    prediction.map_from_scan[0].reset();
    error = evaluate_registration(truth, prediction);
    EXPECT_EQ(error.anchor, 1U);
    EXPECT_EQ(error.scans[0].scan, 0U);
    EXPECT_FALSE(error.scans[0].error);
    // Without any, all but one are missed.
    prediction.map_from_scan.assign(3, std::nullopt);
    error = evaluate_registration(truth, prediction);
    EXPECT_FALSE(error.anchor);
    EXPECT_EQ(error.scans.size(), 2U);
    EXPECT_EQ(registration_recall(error.scans, protocol::loose_pose), 0.0);
    EXPECT_FALSE(translation_rmse(error.scans));
    EXPECT_FALSE(registration_recall({}, protocol::loose_pose));
}

TEST(RegistrationError, DoesNotDependOnTheFrames) {
    GroundTruth truth = truth_of_scans(5);
    Random random(7);
    std::vector<Transform> off(5, Transform::Identity());
    for (std::size_t i = 1; i < off.size(); ++i)
        off[i] = test::small_transform(random, 0.03, 0.1);
    Prediction prediction = result_off_by(truth, off);
    const RegistrationError before = evaluate_registration(truth, prediction);
    const Transform of_truth = test::random_transform(random, 100.0);
    const Transform of_result = test::random_transform(random, 100.0);
    for (Transform& pose : truth.map_from_scan)
        pose = of_truth * pose;
    for (auto& pose : prediction.map_from_scan)
        pose = of_result * *pose;
    const RegistrationError after = evaluate_registration(truth, prediction);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(after.scans[i].error->translation, before.scans[i].error->translation, 1e-9);
        EXPECT_NEAR(after.scans[i].error->rotation, before.scans[i].error->rotation, 1e-7);
        EXPECT_NEAR(after.scans[i].error->translation, 0.1, 1e-9);
    }
}

/// Two scans of 10 coarse voxels each, of which they share `shared`.
GroundTruth overlapping_scans(std::size_t shared) {
    GroundTruth truth = truth_of_scans(2);
    for (std::size_t scan = 0; scan < 2; ++scan) {
        truth.map.sections.push_back({"", static_cast<std::uint32_t>(10 * scan), 10, {}});
        for (std::size_t i = 0; i < 10; ++i) {
            const std::size_t voxel = scan == 0 ? i : 10 - shared + i;
            truth.map.cloud.positions.emplace_back(0.1F + 0.2F * static_cast<float>(voxel), 0.1F,
                                                   0.1F);
        }
    }
    return truth;
}

LinkOutcome judged(const GroundTruth& truth, const Transform& off) {
    Prediction prediction;
    prediction.map_from_scan.resize(2);
    RegistrationLink link;
    link.source = 1;
    link.target = 0;
    link.verdict = LinkVerdict::accepted;
    link.target_from_source = truth.map_from_scan[0].inverse() * truth.map_from_scan[1] * off;
    prediction.links = {link};
    return evaluate_registration(truth, prediction).links.at(0);
}

TEST(RegistrationError, JudgesLinksByPoseAndOverlap) {
    const GroundTruth much = overlapping_scans(3);
    const GroundTruth little = overlapping_scans(2);
    EXPECT_EQ(judged(much, shift(0.05)).truth, LinkTruth::right);
    EXPECT_EQ(judged(much, shift(0.05)).true_overlap, 0.3);
    EXPECT_NEAR(judged(much, shift(0.05)).error.translation, 0.05, 1e-9);
    EXPECT_EQ(judged(much, shift(0.2)).truth, LinkTruth::near);
    EXPECT_EQ(judged(much, turn(3)).truth, LinkTruth::near);
    EXPECT_EQ(judged(much, shift(1.0)).truth, LinkTruth::wrong);
    EXPECT_EQ(judged(much, turn(40)).truth, LinkTruth::wrong);
    EXPECT_EQ(judged(little, shift(0.05)).truth, LinkTruth::right);
    EXPECT_EQ(judged(little, shift(1.0)).truth, LinkTruth::apart);
    EXPECT_EQ(judged(little, shift(1.0)).true_overlap, 0.2);
    // Whose points are whose is not known: no excuse.
    GroundTruth unknown = overlapping_scans(2);
    unknown.map.sections.resize(1);
    EXPECT_EQ(judged(unknown, shift(1.0)).truth, LinkTruth::wrong);
    EXPECT_FALSE(judged(unknown, shift(1.0)).true_overlap);
}

}  // namespace
}  // namespace roomscribe
