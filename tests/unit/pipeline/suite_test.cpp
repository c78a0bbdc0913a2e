// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/suite.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "roomscribe/pipeline/scoring.hpp"

namespace roomscribe {
namespace {

std::ptrdiff_t count_of(const std::vector<SuiteScene>& scenes, ScannerKind scanner) {
    return std::count_if(scenes.begin(), scenes.end(),
                         [&](const SuiteScene& scene) { return scene.options.scanner == scanner; });
}

TEST(Suites, AreAsLargeAsTheirNamesSay) {
    EXPECT_EQ(suite_scenes(SuiteName::quick).size(), 6U);
    EXPECT_GE(suite_scenes(SuiteName::full).size(), 60U);
    EXPECT_EQ(suite_scenes(SuiteName::registration).size(), 40U);

    // The paper's Table 4: 13 data sets, 4 of them complete rooms.
    const std::vector<SuiteScene> paper = suite_scenes(SuiteName::paper);
    EXPECT_EQ(paper.size(), 13U);
    EXPECT_EQ(count_of(paper, ScannerKind::hokuyo_utm30lx), 8);
    EXPECT_EQ(count_of(paper, ScannerKind::sick_lms200), 5);
    EXPECT_EQ(std::count_if(paper.begin(), paper.end(),
                            [](const auto& scene) { return scene.options.scans_per_room > 1; }),
              4);
}

TEST(Suites, HaveNoSceneTwiceAndNoneOfAnotherSeries) {
    for (const SuiteName suite :
         {SuiteName::quick, SuiteName::paper, SuiteName::full, SuiteName::registration}) {
        std::set<std::string> names;
        for (const SuiteScene& scene : suite_scenes(suite))
            EXPECT_TRUE(names.insert(suite_scene_name(scene)).second) << suite_scene_name(scene);
        for (const SuiteScene& scene : suite_scenes(suite, 1))
            EXPECT_TRUE(names.insert(suite_scene_name(scene)).second) << suite_scene_name(scene);
    }
}

TEST(Suites, ASceneIsRunAndScored) {
    const SuiteScene scene{SceneKind::room, 3, {ScannerKind::terrestrial, 2, 8.0}};
    const SuiteSceneResult both = run_suite_scene(scene, false);
    EXPECT_EQ(both.num_scans, 2U);
    EXPECT_TRUE(both.from_scans.registration.has_value());
    ASSERT_TRUE(both.from_true_poses.has_value());
    EXPECT_TRUE(both.from_true_poses->detections.has_value());
    EXPECT_FALSE(both.from_true_poses->registration.has_value());
    const SuiteSceneResult poses = run_suite_scene(scene, true);
    EXPECT_FALSE(poses.from_scans.detections.has_value());
    EXPECT_FALSE(poses.from_true_poses.has_value());
}

/// Truth in the words of a result.
Reconstruction perfect_result(const GroundTruth& truth) {
    Reconstruction result;
    result.map = truth.map;
    result.scene = truth.scene;
    result.labels = {truth.labels, truth.instances, std::vector<float>(truth.labels.size(), 1.0F)};
    return result;
}

TEST(Scoring, TruthAsResultIsAHundredPercent) {
    for (const SceneKind kind : {SceneKind::kitchen, SceneKind::office}) {
        const GroundTruth truth =
            simulate_scene(plan_scene(kind, 5, {ScannerKind::terrestrial, 2, 5.0})).truth;
        const Evaluation score = score_reconstruction(truth, perfect_result(truth));
        ASSERT_TRUE(score.detections && score.points && score.axes);
        for (const DetectionCounts& counts : score.detections->per_label) {
            EXPECT_EQ(counts.correct, counts.ground_truth);
            EXPECT_EQ(counts.false_positives, 0U);
        }
        EXPECT_GT(score.detections->per_label[8].ground_truth, 3U) << "no furniture";
        EXPECT_DOUBLE_EQ(score.points->mean_iou().value_or(0.0), 1.0);
        EXPECT_NEAR(score.axes->up, 0.0, 1e-6);
    }
}

TEST(Scoring, AllUnknownIsNothing) {
    const GroundTruth truth =
        simulate_scene(plan_scene(SceneKind::kitchen, 5, {ScannerKind::terrestrial, 1, 8.0})).truth;
    Reconstruction result = perfect_result(truth);
    result.scene.components.clear();
    std::fill(result.labels.labels.begin(), result.labels.labels.end(), Label::unknown);
    std::fill(result.labels.instances.begin(), result.labels.instances.end(), -1);
    const Evaluation score = score_reconstruction(truth, result);
    for (const DetectionCounts& counts : score.detections->per_label)
        EXPECT_EQ(counts.correct + counts.false_positives, 0U);
    EXPECT_EQ(score.points->mean_iou(), 0.0);
}

TEST(Scoring, EveryPieceThatPointsWereSeenOfIsVisible) {
    const GroundTruth truth =
        simulate_scene(plan_scene(SceneKind::kitchen, 7, {ScannerKind::terrestrial, 2, 4.0})).truth;
    const std::vector<std::size_t> whole = whole_of_component(truth.scene);
    std::vector<std::size_t> points(whole.size(), 0);
    for (const std::int32_t instance : truth.instances) {
        if (instance >= 0) ++points[whole[static_cast<std::size_t>(instance)]];
    }
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const Component& component = truth.scene.components[i];
        if (component.label != Label::furniture || whole[i] != i || points[i] < 2000) continue;
        EXPECT_GT(component.visible.value_or(0.0), 0.1) << component.id << " of " << points[i];
    }
}

}  // namespace
}  // namespace roomscribe
