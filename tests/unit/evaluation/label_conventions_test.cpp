// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/label_conventions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "block_scene.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/evaluation/evaluate.hpp"

namespace roomscribe {
namespace {

constexpr std::int32_t ceiling = 0, floor_class = 1, wall = 2, beam = 3, column = 4, window = 5,
                       door = 6, table = 7, bookcase = 10, board = 11, clutter = 12;

const LabelConvention s3dis = *find_label_convention("s3dis");

GroundTruth truth_of(const std::vector<std::int32_t>& classes,
                     const std::vector<std::int32_t>& instances) {
    ScanMap map;
    for (std::size_t i = 0; i < classes.size(); ++i)
        map.cloud.positions.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    return truth_from_labelled_cloud(std::move(map), classes, instances, s3dis);
}

/// Whether a label is taken for right at a point of a class.
bool is_right(std::int32_t foreign, Label label) {
    return protocol::contains(s3dis.classes[static_cast<std::size_t>(foreign)].acceptable, label);
}

TEST(LabelConventions, S3disHasItsThirteenClasses) {
    ASSERT_EQ(s3dis.classes.size(), 13U);
    for (const ForeignClass& foreign : s3dis.classes)
        EXPECT_TRUE(protocol::contains(foreign.acceptable, foreign.label)) << foreign.name;
    EXPECT_EQ(s3dis.classes[6].name, "door");
    EXPECT_TRUE(is_right(door, Label::door));
    EXPECT_TRUE(is_right(door, Label::door_frame));
    EXPECT_TRUE(is_right(window, Label::window_frame));
    EXPECT_TRUE(is_right(beam, Label::ceiling));
    EXPECT_TRUE(is_right(beam, Label::unknown));
    EXPECT_TRUE(is_right(column, Label::wall));
    EXPECT_TRUE(is_right(bookcase, Label::furniture));
    EXPECT_FALSE(is_right(board, Label::wall));
    EXPECT_FALSE(is_right(wall, Label::unknown));
    EXPECT_FALSE(find_label_convention("S3DIS-2"));
}

TEST(LabelConventions, Nyu40HasItsFortyClassesAndZero) {
    const LabelConvention nyu40 = *find_label_convention("nyu40");
    ASSERT_EQ(nyu40.classes.size(), 41U);
    for (const ForeignClass& foreign : nyu40.classes)
        EXPECT_TRUE(protocol::contains(foreign.acceptable, foreign.label)) << foreign.name;
    EXPECT_EQ(nyu40.classes[8].name, "door");
    EXPECT_EQ(nyu40.classes[14].name, "desk");
    EXPECT_EQ(nyu40.classes[22].label, Label::ceiling);
    EXPECT_EQ(nyu40.classes[24].name, "refrigerator");
    EXPECT_EQ(nyu40.classes[30].name, "whiteboard");
    EXPECT_EQ(nyu40.classes[39].acceptable, protocol::every_label);
}

TEST(LabelConventions, MakeAComponentOfEveryInstanceOfItsClass) {
    // Instances that are counted anew in every class.
    const GroundTruth truth = truth_of(
        {floor_class, wall, wall, wall, table, clutter, door, 13, -1}, {0, 0, 1, 1, 0, 0, 0, 0, 0});
    ASSERT_EQ(truth.scene.components.size(), 4U);
    EXPECT_THAT(truth.instances, testing::ElementsAre(0, 1, 2, 2, 3, -1, -1, -1, -1));
    EXPECT_EQ(truth.scene.components[2].id, "wall-1");
    EXPECT_EQ(truth.scene.components[2].label, Label::wall);
    EXPECT_EQ(truth.scene.components[3].kind, "table");
    EXPECT_EQ(truth.labels[6], Label::door);
    EXPECT_EQ(truth.acceptable[5], protocol::every_label);
    EXPECT_EQ(truth.acceptable[7], protocol::every_label);
    EXPECT_EQ(truth.acceptable[8], protocol::every_label);
}

TEST(LabelConventions, ClutterIsLeftOutOfAllScores) {
    const GroundTruth truth = truth_of({wall, wall, clutter, clutter, clutter}, {0, 0, 1, 1, 1});
    Prediction prediction = test::prediction_of(truth);
    Component other = prediction.scene->components[0];
    other.instance = 9;
    other.label = Label::furniture;
    prediction.scene->components.push_back(other);
    test::relabel(prediction, 2, 3, Label::furniture, 9);
    const Evaluation evaluation = evaluate_result(truth, prediction, s3dis.detected_labels);
    EXPECT_EQ(evaluation.points->mean_iou(), 1.0);
    EXPECT_FALSE(evaluation.points->iou(Label::furniture));
    EXPECT_EQ(evaluation.detections->per_label[8].false_positives, 0U);
    EXPECT_EQ(evaluation.detections->per_label[3].correct, 1U);
}

TEST(LabelConventions, ACloudMayHaveNoInstances) {
    const GroundTruth truth = truth_of({ceiling, wall}, {});
    EXPECT_TRUE(truth.scene.components.empty());
    EXPECT_THAT(truth.instances, testing::ElementsAre(-1, -1));
    EXPECT_THROW(truth_of({wall, wall}, {0}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
