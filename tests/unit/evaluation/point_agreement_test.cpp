// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/point_agreement.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "block_scene.hpp"

namespace roomscribe {
namespace {

using test::BlockScene;
using test::prediction_of;
using test::relabel;

PointAgreement compare(const BlockScene& scene, const Prediction& prediction) {
    return compare_point_labels(scene.truth, *prediction.labels);
}

TEST(PointAgreement, IsIntersectionOverUnionPerLabel) {
    BlockScene scene;
    const std::size_t floor = scene.add_points(50, Label::floor, -1);
    const std::size_t wall = scene.add_points(30, Label::wall, -1);
    scene.add_points(20, Label::unknown, -1);
    Prediction prediction = prediction_of(scene.truth);
    EXPECT_EQ(compare(scene, prediction).mean_iou(), 1.0);
    relabel(prediction, floor, 10, Label::wall, -1);
    relabel(prediction, wall, 6, Label::door, -1);
    const PointAgreement agreement = compare(scene, prediction);
    EXPECT_DOUBLE_EQ(*agreement.iou(Label::floor), 40.0 / 50.0);
    EXPECT_DOUBLE_EQ(*agreement.iou(Label::wall), 24.0 / 40.0);
    EXPECT_DOUBLE_EQ(*agreement.iou(Label::door), 0.0);
    EXPECT_FALSE(agreement.iou(Label::window));
    // Doors are not present in truth; unknown is no label of the mean.
    EXPECT_DOUBLE_EQ(*agreement.mean_iou(), (0.8 + 0.6) / 2.0);
}

TEST(PointAgreement, TakesAnAcceptableLabelForRight) {
    BlockScene scene;
    scene.add_points(10, Label::wall, -1);
    const std::size_t column = scene.add_points(10, Label::unknown, -1, label_bit(Label::wall));
    Prediction prediction = prediction_of(scene.truth);
    EXPECT_EQ(compare(scene, prediction).iou(Label::wall), 1.0);
    relabel(prediction, column, 5, Label::wall, -1);
    EXPECT_EQ(compare(scene, prediction).iou(Label::wall), 1.0);
    EXPECT_EQ(compare(scene, prediction).true_points[3], 10U);
    relabel(prediction, column, 5, Label::floor, -1);
    EXPECT_EQ(compare(scene, prediction).iou(Label::floor), 0.0);
    EXPECT_EQ(compare(scene, prediction).mean_iou(), 1.0);
}

TEST(PointAgreement, LeavesOutPointsThatSayNothing) {
    BlockScene scene;
    const std::size_t wall = scene.add_points(10, Label::wall, -1);
    scene.add_points(10, Label::unknown, -1, protocol::every_label);
    scene.truth.map.cloud.positions[wall].z() = std::numeric_limits<float>::infinity();
    Prediction prediction = prediction_of(scene.truth);
    relabel(prediction, wall, 1, Label::floor, -1);
    relabel(prediction, 10, 10, Label::floor, -1);
    const PointAgreement agreement = compare(scene, prediction);
    EXPECT_EQ(agreement.iou(Label::wall), 1.0);
    EXPECT_FALSE(agreement.iou(Label::floor));
    EXPECT_EQ(agreement.true_points[3], 9U);
    EXPECT_EQ(agreement.true_points[0], 0U);
}

TEST(PointAgreement, OfAllUnknownIsZeroAndOfNothingEmpty) {
    BlockScene scene;
    EXPECT_FALSE(compare(scene, prediction_of(scene.truth)).mean_iou());
    scene.add_points(10, Label::wall, -1);
    scene.add_points(10, Label::handle, -1);
    Prediction prediction = prediction_of(scene.truth);
    relabel(prediction, 0, 20, Label::unknown, -1);
    EXPECT_EQ(compare(scene, prediction).mean_iou(), 0.0);
}

TEST(PointAgreement, AddsUpOverScenes) {
    BlockScene a;
    a.add_points(10, Label::wall, -1);
    BlockScene b;
    b.add_points(30, Label::wall, -1);
    Prediction nothing = prediction_of(b.truth);
    relabel(nothing, 0, 30, Label::unknown, -1);
    PointAgreement sum = compare(a, prediction_of(a.truth));
    sum += compare(b, nothing);
    EXPECT_EQ(sum.iou(Label::wall), 0.25);
    EXPECT_EQ(sum.true_points[3], 40U);
}

}  // namespace
}  // namespace roomscribe
