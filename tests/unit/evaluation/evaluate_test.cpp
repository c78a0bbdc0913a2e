// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/evaluate.hpp"

#include <gtest/gtest.h>

#include "block_scene.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/evaluation/evaluation_summary.hpp"
#include "support/contexts.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using test::BlockScene;
using test::prediction_of;
using test::relabel;
using test::upright_rectangle;

constexpr std::size_t label_id(Label label) {
    return static_cast<std::size_t>(label);
}

/// One component of every label, with points or geometry, and two scans.
GroundTruth complete_truth() {
    BlockScene scene;
    scene.add_block("floor-1", Label::floor, 50);
    scene.add_block("ceiling-1", Label::ceiling, 50);
    scene.add_block("wall-1", Label::wall, 80);
    scene.add_block("cupboard-1", Label::furniture, 20);
    scene.add_block("face-1", Label::furniture, 30, "cupboard-1");
    double x = 0.0;
    for (const Label label : {Label::door, Label::door_frame, Label::window, Label::window_frame}) {
        scene.add_block(std::string(label_name(label)), label, 15);
        scene.truth.scene.components.back().polygon = upright_rectangle({x, 1, 0}, 1.0, 2.0);
        x += 2.0;
    }
    scene.add_block("handle-1", Label::handle, 5);
    scene.truth.scene.components.back().box = OrientedBox{};
    scene.truth.scene.components.back().box->center = {3, 4, 5};
    scene.add_points(40, Label::unknown, -1);
    Random random(3);
    scene.truth.map_from_scan = {test::random_transform(random), test::random_transform(random)};
    scene.truth.scene.room_from_map = test::random_transform(random);
    return scene.truth;
}

/// The same result in another frame.
Prediction moved(Prediction prediction, const Transform& move) {
    prediction.scene = transformed_scene(*prediction.scene, move);
    for (auto& pose : prediction.map_from_scan)
        pose = move * *pose;
    return prediction;
}

void expect_perfect(const Evaluation& evaluation) {
    for (std::size_t id = 1; id < num_labels; ++id) {
        const DetectionCounts& counts = evaluation.detections->per_label[id];
        EXPECT_EQ(counts.ground_truth, 1U) << id;
        EXPECT_EQ(counts.accuracy(), 1.0) << id;
        EXPECT_EQ(counts.precision(), 1.0) << id;
        EXPECT_EQ(evaluation.points->iou(static_cast<Label>(id)), 1.0) << id;
    }
    EXPECT_EQ(evaluation.points->mean_iou(), 1.0);
    EXPECT_LT(evaluation.axes->up, 1e-6);
    EXPECT_LT(evaluation.axes->horizontal, 1e-6);
    ASSERT_EQ(evaluation.registration->scans.size(), 1U);
    EXPECT_LT(evaluation.registration->scans[0].error->translation, 1e-9);
    EXPECT_LT(evaluation.registration->scans[0].error->rotation, 1e-6);
}

TEST(EvaluateResult, FindsTruthPerfectInAnyFrame) {
    const GroundTruth truth = complete_truth();
    expect_perfect(evaluate_result(truth, prediction_of(truth)));
    Random random(4);
    for (int i = 0; i < 20; ++i) {
        const Transform move = test::random_transform(random, 100.0);
        expect_perfect(evaluate_result(truth, moved(prediction_of(truth), move)));
    }
}

TEST(EvaluateResult, FindsNothingInAResultOfUnknowns) {
    const GroundTruth truth = complete_truth();
    Prediction prediction = prediction_of(truth);
    relabel(prediction, 0, truth.labels.size(), Label::unknown, -1);
    prediction.scene->components.clear();
    const Evaluation evaluation = evaluate_result(truth, prediction);
    for (std::size_t id = 1; id < num_labels; ++id) {
        EXPECT_EQ(evaluation.detections->per_label[id].accuracy(), 0.0);
        EXPECT_FALSE(evaluation.detections->per_label[id].precision());
        EXPECT_EQ(evaluation.points->iou(static_cast<Label>(id)), 0.0);
    }
    EXPECT_EQ(evaluation.points->mean_iou(), 0.0);
}

TEST(EvaluateResult, TakesAFrameWithoutPosesForThatOfTheMap) {
    const GroundTruth truth = complete_truth();
    Prediction prediction = prediction_of(truth);
    prediction.map_from_scan.clear();
    Evaluation evaluation = evaluate_result(truth, prediction);
    EXPECT_FALSE(evaluation.registration);
    EXPECT_EQ(evaluation.detections->per_label[label_id(Label::door)].correct, 1U);
    // Then a scene in another frame is a wrong scene, but points stay the same points.
    Random random(5);
    prediction.scene = transformed_scene(*prediction.scene, test::random_transform(random, 10.0));
    evaluation = evaluate_result(truth, prediction);
    EXPECT_EQ(evaluation.detections->per_label[label_id(Label::door)].correct, 0U);
    EXPECT_EQ(evaluation.detections->per_label[label_id(Label::handle)].correct, 0U);
    EXPECT_EQ(evaluation.detections->per_label[label_id(Label::wall)].correct, 1U);
    EXPECT_GT(evaluation.axes->up + evaluation.axes->horizontal, 0.01);
}

/// The number of rectangles (of 4) and handles (of 1) that are found when a result's scene is off
/// along its x axis, which the rectangles span with a width of 1 m.
std::array<std::uint64_t, 2> found_when_shifted(double distance) {
    GroundTruth truth = complete_truth();
    Prediction prediction = prediction_of(truth);
    prediction.scene =
        transformed_scene(*prediction.scene, Transform(Eigen::Translation3d(distance, 0, 0)));
    const Evaluation evaluation = evaluate_result(truth, prediction);
    std::array<std::uint64_t, 2> found{};
    for (const Label label : {Label::door, Label::door_frame, Label::window, Label::window_frame}) {
        found[0] += evaluation.detections->per_label[label_id(label)].correct;
    }
    found[1] = evaluation.detections->per_label[label_id(Label::handle)].correct;
    return found;
}

TEST(EvaluateResult, ShiftsCostWhatAPersonWouldCompute) {
    using Found = std::array<std::uint64_t, 2>;
    EXPECT_EQ(found_when_shifted(0.03), (Found{4, 1}));
    EXPECT_EQ(found_when_shifted(0.10), (Found{4, 0}));  // IoU 0.9 / 1.1
    EXPECT_EQ(found_when_shifted(0.20), (Found{4, 0}));  // IoU 0.8 / 1.2
    EXPECT_EQ(found_when_shifted(0.34), (Found{0, 0}));  // IoU 0.66 / 1.34
}

TEST(EvaluateResult, ScoresWhatIsThere) {
    const GroundTruth truth = complete_truth();
    Prediction registered;
    registered.map_from_scan = prediction_of(truth).map_from_scan;
    const Evaluation evaluation = evaluate_result(truth, registered);
    EXPECT_TRUE(evaluation.registration);
    EXPECT_FALSE(evaluation.detections);
    EXPECT_FALSE(evaluation.points);
    EXPECT_FALSE(evaluation.axes);
}

TEST(EvaluateResult, GivesTheSameOnAnyNumberOfThreads) {
    const GroundTruth truth = complete_truth();
    const Prediction prediction = prediction_of(truth);
    const auto scores = [&](int num_threads) {
        std::vector<double> values;
        const Evaluation evaluation = evaluate_result(truth, prediction, protocol::every_label,
                                                      test::with_threads(num_threads));
        for (const DetectionMatch& match : evaluation.detections->matches)
            values.push_back(match.score);
        return values;
    };
    EXPECT_EQ(scores(1), scores(4));
}

TEST(EvaluateResult, RefusesWhatDoesNotBelongTogether) {
    const GroundTruth truth = complete_truth();
    Prediction prediction = prediction_of(truth);
    prediction.labels->labels.pop_back();
    EXPECT_THROW(evaluate_result(truth, prediction), InvalidArgument);
    prediction = prediction_of(truth);
    prediction.map_from_scan.pop_back();
    EXPECT_THROW(evaluate_result(truth, prediction), InvalidArgument);
    prediction = prediction_of(truth);
    prediction.links.emplace_back().source = 2;
    EXPECT_THROW(evaluate_result(truth, prediction), InvalidArgument);
}

TEST(TransformedScene, MovesEverythingAndKeepsTheRoom) {
    Random random(6);
    Scene scene = complete_truth().scene;
    scene.components[0].grasp = Grasp{{1, 2, 3}, {1, 0, 0}, {0, 1, 0}, 0.02};
    const Transform move = test::random_transform(random, 5.0);
    const Scene there = transformed_scene(scene, move);
    EXPECT_TRUE(there.components[0].grasp->position.isApprox(move * Eigen::Vector3d(1, 2, 3)));
    EXPECT_TRUE(there.components[0].grasp->axis.isApprox(move.linear().col(0)));
    EXPECT_TRUE(there.components[0].grasp->approach.isApprox(move.linear().col(1)));
    EXPECT_TRUE(there.components.back().box->axes[2].isApprox(move.linear().col(2)));
    const Scene back = transformed_scene(there, move.inverse());
    EXPECT_TRUE(back.room_from_map.isApprox(scene.room_from_map));
    EXPECT_TRUE(back.components[5].polygon[2].isApprox(scene.components[5].polygon[2]));
    EXPECT_TRUE((there.room_from_map * (move * Eigen::Vector3d(1, 2, 3)))
                    .isApprox(scene.room_from_map * Eigen::Vector3d(1, 2, 3)));
}

TEST(Summarize, AddsCountsAndSortsErrors) {
    const GroundTruth truth = complete_truth();
    Prediction off = prediction_of(truth);
    off.map_from_scan[1] = *off.map_from_scan[1] * Transform(Eigen::Translation3d(0.25, 0, 0));
    off.scene->components.pop_back();
    Prediction unplaced = prediction_of(truth);
    unplaced.map_from_scan[1].reset();
    const std::vector<Evaluation> evaluations{evaluate_result(truth, off),
                                              evaluate_result(truth, prediction_of(truth)),
                                              evaluate_result(truth, unplaced)};
    const EvaluationSummary summary = summarize(evaluations);
    EXPECT_EQ(summary.scenes, 3U);
    const DetectionCounts& handles = summary.detections[label_id(Label::handle)];
    EXPECT_EQ(handles.ground_truth, 3U);
    EXPECT_EQ(handles.correct, 2U);
    EXPECT_EQ(handles.scenes, 3U);
    EXPECT_EQ(summary.up_errors.size(), 3U);
    EXPECT_EQ(summary.scans.size(), 3U);
    ASSERT_EQ(summary.translation_errors.size(), 2U);
    EXPECT_NEAR(summary.translation_errors[0], 0.0, 1e-9);
    EXPECT_NEAR(summary.translation_errors[1], 0.25, 1e-9);
    EXPECT_NEAR(*registration_recall(summary.scans, protocol::strict_pose), 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(*registration_recall(summary.scans, protocol::loose_pose), 2.0 / 3.0, 1e-12);
}

TEST(Percentile, IsTheNearestRank) {
    const std::vector<double> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    EXPECT_EQ(percentile(values, 0.0), 1);
    EXPECT_EQ(percentile(values, 0.5), 5);
    EXPECT_EQ(percentile(values, 0.51), 6);
    EXPECT_EQ(percentile(values, 0.9), 9);
    EXPECT_EQ(percentile(values, 1.0), 10);
    EXPECT_EQ(percentile(std::vector<double>{7}, 0.5), 7);
    EXPECT_FALSE(percentile({}, 0.5));
}

}  // namespace
}  // namespace roomscribe
