// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/results_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/score_list.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;
using testing::Not;

EvaluationSummary some_summary() {
    EvaluationSummary summary;
    summary.scenes = 2;
    summary.detections[static_cast<std::size_t>(Label::wall)] = {8, 6, 2, 2};
    summary.detections[static_cast<std::size_t>(Label::handle)] = {4, 0, 0, 1};
    summary.up_errors = {radians(0.25), radians(1.5)};
    summary.horizontal_errors = {0.0, radians(2.0)};
    return summary;
}

TEST(ResultsTable, TextHasAlignedColumnsAndUnits) {
    EXPECT_EQ(summary_to_text(some_summary()),
              "detection     ground truth  correct  accuracy  false positives  precision      f1  "
              "scenes\n"
              "floor                    0        0         -                0          -       -  "
              "     0\n"
              "ceiling                  0        0         -                0          -       -  "
              "     0\n"
              "wall                     8        6    75.0 %                2     75.0 %  75.0 %  "
              "     2\n"
              "door_frame               0        0         -                0          -       -  "
              "     0\n"
              "door                     0        0         -                0          -       -  "
              "     0\n"
              "window_frame             0        0         -                0          -       -  "
              "     0\n"
              "window                   0        0         -                0          -       -  "
              "     0\n"
              "furniture                0        0         -                0          -       -  "
              "     0\n"
              "handle                   4        0     0.0 %                0          -   0.0 %  "
              "     1\n"
              "all                     12        6    50.0 %                2     75.0 %  60.0 %  "
              "     2\n"
              "\n"
              "axes        count    median       p90       max\n"
              "up              2  0.25 deg  1.50 deg  1.50 deg\n"
              "horizontal      2  0.00 deg  2.00 deg  2.00 deg\n");
}

TEST(ResultsTable, MarkdownHasTheSameTables) {
    const std::string text = summary_to_markdown(some_summary());
    EXPECT_THAT(text, HasSubstr("### axes\n\n|  | count | median | p90 | max |\n"
                                "|---|---:|---:|---:|---:|\n"
                                "| up | 2 | 0.25 deg | 1.50 deg | 1.50 deg |\n"));
    EXPECT_THAT(text, HasSubstr("| wall | 8 | 6 | 75.0 % | 2 | 75.0 % | 75.0 % | 2 |\n"));
    EXPECT_THAT(text, Not(HasSubstr("### links")));
}

TEST(ResultsTable, CsvHasOneLineAValue) {
    const std::string text = summary_to_csv(some_summary());
    EXPECT_THAT(text, testing::StartsWith("group,item,measure,value\n"
                                          "detection,\"floor\",ground_truth,0\n"));
    EXPECT_THAT(text, HasSubstr("\ndetection,\"wall\",accuracy,0.75\n"));
    EXPECT_THAT(text, HasSubstr("\ndetection,\"handle\",precision,\n"));
    EXPECT_THAT(text, HasSubstr("\naxes,\"up\",median,0.25\n"));
    EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')),
              1 + list_scores(some_summary()).size());
}

TEST(ResultsTable, JsonNestsTheSameValues) {
    const std::string text = summary_to_json(some_summary());
    EXPECT_THAT(text, HasSubstr("\"format\": \"roomscribe-evaluation\""));
    EXPECT_THAT(text, HasSubstr("    \"wall\": {\n      \"ground_truth\": 8,\n      \"correct\": "
                                "6,\n      \"accuracy\": 0.75,\n"));
    EXPECT_THAT(text, HasSubstr("\"precision\": null"));
}

TEST(ResultsTable, RegistrationHasItsOwnTables) {
    EvaluationSummary summary;
    summary.scenes = 1;
    summary.scans = {{1, PoseError{0.05, radians(0.5)}}, {2, PoseError{0.25, radians(3)}}, {3, {}}};
    summary.translation_errors = {0.05, 0.25};
    summary.rotation_errors = {radians(0.5), radians(3)};
    summary.links[0][static_cast<std::size_t>(LinkTruth::right)] = 5;
    summary.links[2][static_cast<std::size_t>(LinkTruth::apart)] = 3;
    const std::string text = summary_to_text(summary);
    EXPECT_EQ(text,
              "registration  count    median       p90       max     rmse\n"
              "translation       2   0.050 m   0.250 m   0.250 m  0.180 m\n"
              "rotation          2  0.50 deg  3.00 deg  3.00 deg\n"
              "\n"
              "recall        scans  recall\n"
              "0.1 m, 1 deg      3  33.3 %\n"
              "0.3 m, 5 deg      3  66.7 %\n"
              "\n"
              "links      right  near  wrong  apart\n"
              "accepted       5     0      0      0\n"
              "ambiguous      0     0      0      0\n"
              "rejected       0     0      0      3\n");
}

TEST(ResultsTable, RoomsAndDecoysHaveTheirOwnTables) {
    EvaluationSummary summary;
    summary.scenes = 2;
    summary.decoys[static_cast<std::size_t>(DecoyKind::picture)] = {40, 1};
    summary.decoys[static_cast<std::size_t>(DecoyKind::niche)] = {10, 1};
    summary.opening_grounds[static_cast<std::size_t>(OpeningGround::opening)] = 99;
    summary.opening_grounds[static_cast<std::size_t>(OpeningGround::hidden_wall)] = 1;
    summary.rooms = {4, 3, 1, 2};
    summary.area_errors = {0.0, 0.01, 0.25};
    summary.height_errors = {0.001, 0.002, 0.5};
    const std::string text = summary_to_text(summary);
    EXPECT_EQ(text,
              "decoys   there  taken   share\n"
              "picture     40      1   2.5 %\n"
              "board        0      0       -\n"
              "mirror       0      0       -\n"
              "screen       0      0       -\n"
              "niche       10      1  10.0 %\n"
              "all         50      2   4.0 %\n"
              "\n"
              "openings     detections   share\n"
              "opening              99  99.0 %\n"
              "decoy                 0   0.0 %\n"
              "hidden_wall           1   1.0 %\n"
              "seen_wall             0   0.0 %\n"
              "elsewhere             0   0.0 %\n"
              "\n"
              "rooms       ground truth  correct  accuracy  false positives  precision      f1  "
              "scenes\n"
              "room                   4        3    75.0 %                1     75.0 %  75.0 %  "
              "     2\n"
              "neighbours             0        0         -                0          -       -  "
              "     0\n"
              "\n"
              "room_sizes  count   median      p90      max\n"
              "area            3    1.0 %   25.0 %   25.0 %\n"
              "height          3  0.002 m  0.500 m  0.500 m\n"
              "volume          0        -        -        -\n");
    EXPECT_THAT(summary_to_json(summary), HasSubstr("\"room_sizes\": {\n    \"area\""));
}

TEST(ResultsTable, OfNothingIsEmpty) {
    EXPECT_EQ(summary_to_text({}), "");
    EXPECT_EQ(summary_to_markdown({}), "");
    EXPECT_EQ(summary_to_csv({}), "group,item,measure,value\n");
}

TEST(ResultsTable, JsonOfOneSceneNamesEveryComponentScanAndLink) {
    Evaluation evaluation;
    evaluation.detections.emplace();
    DetectionMatch match;
    match.label = Label::door;
    match.outcome = DetectionOutcome::correct;
    match.true_id = "door-\xff";
    match.predicted_id = "door-2";
    match.score = 0.75;
    match.confidence = 0.5;
    match.verdict = Verdict::doubtful;
    evaluation.detections->matches = {match};
    evaluation.registration.emplace();
    evaluation.registration->scans = {{1, PoseError{0.05, radians(0.5)}}, {2, {}}};
    evaluation.registration->links.emplace_back();
    const std::string text = evaluation_to_json(evaluation);
    EXPECT_THAT(text,
                HasSubstr("\"outcome\": \"correct\",\n      \"true\": \"door-\xEF\xBF\xBD\",\n"
                          "      \"predicted\": \"door-2\",\n      \"score\": 0.75,\n"
                          "      \"confidence\": 0.5,\n      \"verdict\": \"doubtful\""));
    EXPECT_THAT(text, HasSubstr("\"scan\": 2,\n      \"placed\": false"));
    EXPECT_THAT(text, HasSubstr("\"true_overlap\": null"));
}

}  // namespace
}  // namespace roomscribe
