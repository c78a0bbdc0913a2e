// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/detection_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "block_scene.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/component_fit.hpp"

namespace roomscribe {
namespace {

using test::BlockScene;
using test::prediction_of;
using test::relabel;
using test::upright_rectangle;

/// Ground truth, correct, false positives.
using Counts = std::array<std::uint64_t, 3>;

Counts counts_of(const DetectionError& error, Label label) {
    const DetectionCounts& counts = error.per_label[static_cast<std::size_t>(label)];
    return {counts.ground_truth, counts.correct, counts.false_positives};
}

Counts counts_of(const BlockScene& scene, const Prediction& prediction, Label label) {
    return counts_of(evaluate_detections(scene.truth, prediction), label);
}

/// The pairs that were matched, with their scores.
std::vector<std::tuple<std::string, std::string, double>> pairs_of(const DetectionError& error) {
    std::vector<std::tuple<std::string, std::string, double>> pairs;
    for (const DetectionMatch& match : error.matches) {
        if (!match.true_id.empty() && !match.predicted_id.empty())
            pairs.emplace_back(match.true_id, match.predicted_id, match.score);
    }
    return pairs;
}

TEST(DetectionCounts, RatiosAreThoseOfTheirDefinition) {
    const DetectionCounts counts{8, 6, 4, 2};
    EXPECT_DOUBLE_EQ(*counts.accuracy(), 0.75);
    EXPECT_DOUBLE_EQ(*counts.precision(), 0.6);
    EXPECT_DOUBLE_EQ(*counts.f1(), 2 * 0.75 * 0.6 / (0.75 + 0.6));
    EXPECT_FALSE(DetectionCounts{}.accuracy());
    EXPECT_FALSE(DetectionCounts{}.precision());
    EXPECT_FALSE(DetectionCounts{}.f1());
    EXPECT_EQ((DetectionCounts{3, 0, 0, 1}.accuracy()), 0.0);
    EXPECT_FALSE((DetectionCounts{3, 0, 0, 1}.precision()));
}

TEST(Detections, OfInstancesNeedHalfOfTheVoxels) {
    // 100 voxels of wall; the detection has n of them and m voxels of nothing.
    const auto counts = [](std::size_t n, std::size_t m) {
        BlockScene scene;
        const std::size_t first = scene.add_block("wall-1", Label::wall, 100);
        const std::size_t rest = scene.add_points(200, Label::unknown, -1);
        Prediction prediction = prediction_of(scene.truth);
        relabel(prediction, first, 100 - n, Label::unknown, -1);
        relabel(prediction, rest, m, Label::wall, 10);
        return counts_of(scene, prediction, Label::wall);
    };
    EXPECT_EQ(counts(100, 0), (Counts{1, 1, 0}));
    EXPECT_EQ(counts(50, 0), (Counts{1, 1, 0}));
    EXPECT_EQ(counts(49, 0), (Counts{1, 0, 1}));
    EXPECT_EQ(counts(100, 100), (Counts{1, 1, 0}));
    EXPECT_EQ(counts(100, 101), (Counts{1, 0, 1}));
    EXPECT_EQ(counts(75, 50), (Counts{1, 1, 0}));
    EXPECT_EQ(counts(75, 51), (Counts{1, 0, 1}));
    EXPECT_EQ(counts(0, 100), (Counts{1, 0, 1}));
    // A wall that no point belongs to is made up.
    EXPECT_EQ(counts(0, 0), (Counts{1, 0, 1}));
}

TEST(Detections, EveryVoxelCountsOnce) {
    BlockScene scene;
    const std::size_t first = scene.add_block("wall-1", Label::wall, 10);
    // 1000 more points in the first voxel: near the scanner the wall is dense.
    for (int i = 0; i < 1000; ++i) {
        scene.truth.map.cloud.positions.push_back(scene.truth.map.cloud.positions[first]);
        scene.truth.labels.push_back(Label::wall);
        scene.truth.instances.push_back(10);
        scene.truth.acceptable.push_back(label_bit(Label::wall));
    }
    Prediction dense = prediction_of(scene.truth);
    relabel(dense, first + 1, 9, Label::unknown, -1);
    EXPECT_EQ(counts_of(scene, dense, Label::wall), (Counts{1, 0, 1}));
    Prediction sparse = prediction_of(scene.truth);
    relabel(sparse, first, 1, Label::unknown, -1);
    relabel(sparse, 10, 1000, Label::unknown, -1);
    const DetectionError error = evaluate_detections(scene.truth, sparse);
    EXPECT_EQ(counts_of(error, Label::wall), (Counts{1, 1, 0}));
    EXPECT_NEAR(std::get<2>(pairs_of(error).at(0)), 0.9, 1e-6);
}

TEST(Detections, PointsWithoutCoordinatesDoNotCount) {
    BlockScene scene;
    const std::size_t first = scene.add_block("wall-1", Label::wall, 10);
    Prediction prediction = prediction_of(scene.truth);
    relabel(prediction, first, 8, Label::unknown, -1);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 0, 1}));
    for (std::size_t i = first; i < first + 6; ++i)
        scene.truth.map.cloud.positions[i].x() = std::nanf("");
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 1, 0}));
}

TEST(Detections, ShuffledInstanceNumbersChangeNothing) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 30);
    scene.add_block("wall-2", Label::wall, 40);
    scene.add_block("floor-1", Label::floor, 50);
    Prediction prediction = prediction_of(scene.truth);
    for (Component& component : prediction.scene->components)
        component.instance = 1000 - component.instance;
    std::swap(prediction.scene->components[0], prediction.scene->components[2]);
    for (std::int32_t& instance : prediction.labels->instances)
        instance = 1000 - instance;
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{2, 2, 0}));
    EXPECT_EQ(counts_of(scene, prediction, Label::floor), (Counts{1, 1, 0}));
    // Numbers that no longer go with the components find only what is the same by chance.
    std::swap(prediction.scene->components[0].instance, prediction.scene->components[1].instance);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{2, 1, 1}));
    EXPECT_EQ(counts_of(scene, prediction, Label::floor), (Counts{1, 0, 1}));
}

TEST(Detections, TwoWallsTakenForOneAndOneForTwo) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 60);
    const std::size_t second = scene.add_block("wall-2", Label::wall, 40);
    Prediction merged = prediction_of(scene.truth);
    merged.scene->components.pop_back();
    relabel(merged, second, 40, Label::wall, 10);
    // 60 of 100 voxels are the first wall's.
    EXPECT_EQ(counts_of(scene, merged, Label::wall), (Counts{2, 1, 0}));

    Prediction split = prediction_of(scene.truth);
    split.scene->components.push_back(split.scene->components[0]);
    split.scene->components.back().instance = 77;
    split.scene->components.back().id = "wall-3";
    relabel(split, 0, 25, Label::wall, 77);
    EXPECT_EQ(counts_of(scene, split, Label::wall), (Counts{2, 2, 1}));
    relabel(split, 0, 31, Label::wall, 77);  // 31 and 29 of 60: now the new one is the better
    const auto pairs = pairs_of(evaluate_detections(scene.truth, split));
    EXPECT_EQ(std::get<1>(pairs.at(1)), "wall-3");
    EXPECT_NEAR(std::get<2>(pairs[1]), 31.0 / 60.0, 1e-6);
}

TEST(Detections, AColumnTakenForAWallNeitherHelpsNorHurts) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 40);
    const std::int32_t column = scene.add("column-1", Label::unknown).instance;
    const std::size_t first = scene.add_points(100, Label::unknown, column, label_bit(Label::wall));
    // As part of the wall.
    Prediction prediction = prediction_of(scene.truth);
    relabel(prediction, first, 100, Label::wall, 10);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 1, 0}));
    EXPECT_NEAR(std::get<2>(pairs_of(evaluate_detections(scene.truth, prediction)).at(0)), 1.0,
                1e-6);
    // As a wall of its own.
    Component own = prediction.scene->components[0];
    own.id = "wall-2";
    own.instance = 50;
    prediction.scene->components.push_back(own);
    relabel(prediction, first, 100, Label::wall, 50);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 1, 0}));
    // As furniture it is wrong.
    own.label = Label::furniture;
    prediction.scene->components.back() = own;
    relabel(prediction, first, 100, Label::furniture, 50);
    EXPECT_EQ(counts_of(scene, prediction, Label::furniture), (Counts{0, 0, 1}));
}

TEST(Detections, AnAcceptableLabelForAWallPointDoesNotHurtTheWall) {
    BlockScene scene;
    scene.add("wall-1", Label::wall);
    scene.add_points(40, Label::wall, 10);
    const std::size_t lining = scene.add_points(60, Label::wall, 10, label_bit(Label::door_frame));
    Prediction prediction = prediction_of(scene.truth);
    relabel(prediction, lining, 60, Label::door_frame, -1);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 1, 0}));
    relabel(prediction, lining, 60, Label::furniture, -1);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 0, 1}));
}

TEST(Detections, PointsWithoutAListedComponentAreLeftOut) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 40);
    const std::size_t first = scene.add_points(100, Label::wall, 99);
    Prediction prediction = prediction_of(scene.truth);
    relabel(prediction, first, 100, Label::wall, 10);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 1, 0}));
    Component other = prediction.scene->components[0];
    other.instance = 99;
    prediction.scene->components.push_back(other);
    relabel(prediction, first, 100, Label::wall, 99);
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 1, 0}));
}

TEST(Detections, OfRectanglesDoNotDependOnPoints) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 10);
    // The lining of a door, which is labelled as its frame; the frame itself is elsewhere.
    const std::size_t lining = scene.add_points(10, Label::wall, 10, label_bit(Label::door_frame));
    scene.add("frame-1", Label::door_frame).polygon = upright_rectangle({3, 0, 0}, 1.0, 2.0);
    Prediction prediction = prediction_of(scene.truth);
    EXPECT_EQ(counts_of(scene, prediction, Label::door_frame), (Counts{1, 1, 0}));
    relabel(prediction, lining, 10, Label::door_frame, 11);
    EXPECT_EQ(counts_of(scene, prediction, Label::door_frame), (Counts{1, 1, 0}));
    prediction.scene->components[1].polygon = upright_rectangle({5, 0, 0}, 1.0, 2.0);
    EXPECT_EQ(counts_of(scene, prediction, Label::door_frame), (Counts{1, 0, 1}));
}

TEST(Detections, FacesCountWithTheirPiece) {
    BlockScene scene;
    scene.add_block("cupboard", Label::furniture, 10, "room-1");
    scene.add_block("door-face", Label::furniture, 40, "cupboard");
    scene.add_block("drawer-face", Label::furniture, 50, "door-face");
    Prediction prediction = prediction_of(scene.truth);
    EXPECT_EQ(counts_of(scene, prediction, Label::furniture), (Counts{1, 1, 0}));
    // Found as one thing without faces.
    relabel(prediction, 0, 100, Label::furniture, 10);
    prediction.scene->components.resize(1);
    EXPECT_EQ(counts_of(scene, prediction, Label::furniture), (Counts{1, 1, 0}));
    // Found as two things, of which the faces are too little.
    Prediction apart = prediction_of(scene.truth);
    apart.scene->components[1].parent = "room-1";
    EXPECT_EQ(counts_of(scene, apart, Label::furniture), (Counts{1, 1, 1}));
    apart.scene->components[2].parent = "not there";
    EXPECT_EQ(counts_of(scene, apart, Label::furniture), (Counts{1, 1, 2}));
}

TEST(Detections, ParentsThatGoInCirclesEnd) {
    BlockScene scene;
    scene.add_block("a", Label::furniture, 10, "b");
    scene.add_block("b", Label::furniture, 10, "a");
    scene.add_block("c", Label::furniture, 10, "c");
    const std::vector<std::size_t> whole = whole_of_component(scene.truth.scene);
    EXPECT_EQ(whole[2], 2U);
    EXPECT_LT(std::max(whole[0], whole[1]), 2U);
}

TEST(Detections, HardlyVisibleComponentsAreIgnored) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 40);
    scene.add_block("wall-2", Label::wall, 40);
    scene.truth.scene.components[1].visible = 0.29;
    Prediction both = prediction_of(scene.truth);
    EXPECT_EQ(counts_of(scene, both, Label::wall), (Counts{1, 1, 0}));
    Prediction one = both;
    one.scene->components.pop_back();
    EXPECT_EQ(counts_of(scene, one, Label::wall), (Counts{1, 1, 0}));
    const DetectionError error = evaluate_detections(scene.truth, one);
    EXPECT_EQ(error.matches.back().outcome, DetectionOutcome::ignored);
    // At the limit, and where truth does not say, components count.
    scene.truth.scene.components[1].visible = 0.3;
    EXPECT_EQ(counts_of(scene, one, Label::wall), (Counts{2, 1, 0}));
    scene.truth.scene.components[1].visible.reset();
    EXPECT_EQ(counts_of(scene, one, Label::wall), (Counts{2, 1, 0}));
}

TEST(Detections, RejectedOnesAreNone) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 40);
    Prediction prediction = prediction_of(scene.truth);
    prediction.scene->components[0].verdict = Verdict::doubtful;
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 1, 0}));
    prediction.scene->components[0].verdict = Verdict::rejected;
    EXPECT_EQ(counts_of(scene, prediction, Label::wall), (Counts{1, 0, 0}));
}

TEST(Detections, OnlyTheLabelsThatWereAskedForAreCounted) {
    BlockScene scene;
    scene.add_block("wall-1", Label::wall, 40);
    scene.add_block("floor-1", Label::floor, 40);
    const DetectionError error =
        evaluate_detections(scene.truth, prediction_of(scene.truth), label_bit(Label::floor));
    EXPECT_EQ(counts_of(error, Label::wall), (Counts{0, 0, 0}));
    EXPECT_EQ(counts_of(error, Label::floor), (Counts{1, 1, 0}));
}

/// A door of 1 x 2 m in the plane y = 0, detected as its corners moved by `move`.
Counts door_moved(const Transform& move, Label label = Label::door) {
    BlockScene scene;
    scene.add("door-1", label).polygon = upright_rectangle({3, 0, 0}, 1.0, 2.0);
    Prediction prediction = prediction_of(scene.truth);
    for (Eigen::Vector3d& corner : prediction.scene->components[0].polygon)
        corner = move * corner;
    return counts_of(scene, prediction, label);
}

Transform shift(double x, double y, double z) {
    return Transform(Eigen::Translation3d(x, y, z));
}

/// A turn about the upright line through the middle of the door.
Transform turn(double angle) {
    return Eigen::Translation3d(3.5, 0, 1) *
           Transform(Eigen::AngleAxisd(radians(angle), Eigen::Vector3d::UnitZ())) *
           Eigen::Translation3d(-3.5, 0, -1);
}

TEST(Detections, OfRectanglesNeedPlaneAndHalfOfTheArea) {
    constexpr Counts hit{1, 1, 0};
    constexpr Counts miss{1, 0, 1};
    for (const Label label : {Label::door, Label::door_frame, Label::window, Label::window_frame}) {
        EXPECT_EQ(door_moved(shift(0, 0, 0), label), hit);
        // Along the wall by s: IoU = (1 - s) / (1 + s).
        EXPECT_EQ(door_moved(shift(0.33, 0, 0), label), hit);
        EXPECT_EQ(door_moved(shift(0.34, 0, 0), label), miss);
        EXPECT_EQ(door_moved(shift(0, 0, 0.66), label), hit);
        EXPECT_EQ(door_moved(shift(0, 0, 0.67), label), miss);
        EXPECT_EQ(door_moved(shift(0, 0.15, 0), label), hit);
        EXPECT_EQ(door_moved(shift(0, 0.151, 0), label), miss);
        EXPECT_EQ(door_moved(shift(0, -0.151, 0), label), miss);
        EXPECT_EQ(door_moved(turn(9.9), label), hit);
        EXPECT_EQ(door_moved(turn(-10.1), label), miss);
        EXPECT_EQ(door_moved(turn(180), label), hit);
    }
    EXPECT_EQ(door_moved(shift(0.2, 0, 0) * turn(0)), hit);
    EXPECT_EQ(door_moved(shift(0.2, 0, 0.5)), miss);  // 0.8 * 1.5 / (4 - 1.2) = 0.43
}

TEST(Detections, RectanglesRunEitherWayRoundAndStartAnywhere) {
    BlockScene scene;
    scene.add("door-1", Label::door).polygon = upright_rectangle({3, 0, 0}, 1.0, 2.0);
    Prediction prediction = prediction_of(scene.truth);
    auto& corners = prediction.scene->components[0].polygon;
    std::reverse(corners.begin(), corners.end());
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    EXPECT_EQ(counts_of(scene, prediction, Label::door), (Counts{1, 1, 0}));
    corners.resize(2);
    EXPECT_EQ(counts_of(scene, prediction, Label::door), (Counts{1, 0, 1}));
}

TEST(Detections, OfHandlesNeedTheirCentre) {
    const auto counts = [](double off) {
        BlockScene scene;
        Component& handle = scene.add("handle-1", Label::handle);
        handle.box = OrientedBox{};
        handle.box->center = {1, 2, 3};
        Prediction prediction = prediction_of(scene.truth);
        prediction.scene->components[0].box->center.z() += off;
        return counts_of(scene, prediction, Label::handle);
    };
    EXPECT_EQ(counts(0.0), (Counts{1, 1, 0}));
    EXPECT_EQ(counts(0.03), (Counts{1, 1, 0}));
    EXPECT_EQ(counts(0.05), (Counts{1, 1, 0}));
    EXPECT_EQ(counts(0.051), (Counts{1, 0, 1}));
    EXPECT_EQ(counts(0.2), (Counts{1, 0, 1}));
}

/// Handles in a row along x at the given places.
void add_handles(Scene& scene, const std::vector<double>& places) {
    scene.components.clear();
    for (const double place : places) {
        Component handle;
        handle.id = std::to_string(scene.components.size());
        handle.label = Label::handle;
        handle.box = OrientedBox{};
        handle.box->center.x() = place;
        handle.verdict = Verdict::accepted;
        scene.components.push_back(handle);
    }
}

TEST(Detections, AreMatchedBestFirstAndOnce) {
    BlockScene scene;
    add_handles(scene.truth.scene, {0.0, 0.04});
    Prediction prediction = prediction_of(scene.truth);
    // 0.03 is nearest to the second; the first gets what is left, which is too far.
    add_handles(*prediction.scene, {0.03, 0.075});
    DetectionError error = evaluate_detections(scene.truth, prediction);
    EXPECT_EQ(counts_of(error, Label::handle), (Counts{2, 1, 1}));
    ASSERT_EQ(pairs_of(error).size(), 1U);
    EXPECT_EQ(std::get<0>(pairs_of(error)[0]), "1");
    EXPECT_EQ(std::get<1>(pairs_of(error)[0]), "0");
    EXPECT_NEAR(std::get<2>(pairs_of(error)[0]), 0.8, 1e-9);
    // Three detections of one handle: one hit, two false positives.
    add_handles(scene.truth.scene, {0.0});
    add_handles(*prediction.scene, {0.01, -0.005, 0.02});
    error = evaluate_detections(scene.truth, prediction);
    EXPECT_EQ(counts_of(error, Label::handle), (Counts{1, 1, 2}));
    EXPECT_EQ(std::get<1>(pairs_of(error)[0]), "1");
}

TEST(Detections, AreMatchedWithWhatCountsBeforeWhatIsIgnored) {
    BlockScene scene;
    add_handles(scene.truth.scene, {0.0, 0.04});
    scene.truth.scene.components[0].visible = 0.1;
    Prediction prediction = prediction_of(scene.truth);
    add_handles(*prediction.scene, {0.01});  // nearer to the ignored one
    EXPECT_EQ(counts_of(scene, prediction, Label::handle), (Counts{1, 1, 0}));
    add_handles(*prediction.scene, {0.01, 0.03});
    EXPECT_EQ(counts_of(scene, prediction, Label::handle), (Counts{1, 1, 0}));
    add_handles(*prediction.scene, {-0.04, 0.03});
    EXPECT_EQ(counts_of(scene, prediction, Label::handle), (Counts{1, 1, 0}));
    add_handles(*prediction.scene, {-0.06, 0.03});
    EXPECT_EQ(counts_of(scene, prediction, Label::handle), (Counts{1, 1, 1}));
}

TEST(Detections, HandlesWithoutABoxHaveTheirPolygonOrGrasp) {
    Component component;
    EXPECT_FALSE(component_center(component));
    component.grasp = Grasp{};
    component.grasp->position = {1, 2, 3};
    EXPECT_EQ(component_center(component), Eigen::Vector3d(1, 2, 3));
    component.polygon = upright_rectangle({0, 0, 0}, 2, 4);
    EXPECT_EQ(component_center(component), Eigen::Vector3d(1, 0, 2));
    component.box = OrientedBox{};
    EXPECT_EQ(component_center(component), Eigen::Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace roomscribe
