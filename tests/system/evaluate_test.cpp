// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/pipeline/truth_folder.hpp"
#include "roomscribe/pipeline/workspace.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;

/// A wall and a door that two scans saw, as truth and, shifted by `distance` along the wall, as a
/// result.
struct SmallScene {
    std::vector<Scan> scans{2};
    GroundTruth truth;
    Reconstruction result;

    explicit SmallScene(double distance = 0.0) {
        for (int i = 0; i < 20; ++i) {
            for (Scan& scan : scans)
                scan.cloud.positions.emplace_back(0.1F * static_cast<float>(i), 2.0F, 1.0F);
        }
        truth.map_from_scan.assign(2, Transform::Identity());
        truth.map_from_scan[1].translation().z() = 1.0;
        const std::vector<std::optional<Transform>> poses{truth.map_from_scan[0],
                                                          truth.map_from_scan[1]};
        truth.map = merge_scans(scans, poses);
        Component wall;
        wall.id = "wall-1";
        wall.label = Label::wall;
        wall.instance = 1;
        wall.verdict = Verdict::accepted;
        wall.confidence = 0.9;
        wall.visible = 1.0;
        Component door = wall;
        door.id = "door-1";
        door.label = Label::door;
        door.instance = 2;
        door.polygon = {{0, 2, 0}, {1, 2, 0}, {1, 2, 2}, {0, 2, 2}};
        truth.scene.components = {wall, door};
        truth.labels.assign(40, Label::wall);
        truth.instances.assign(40, 1);
        truth.acceptable.assign(40, label_bit(Label::wall));

        result.map = truth.map;
        result.scene = truth.scene;
        for (Eigen::Vector3d& corner : result.scene.components[1].polygon)
            corner.x() += distance;
        result.labels = {truth.labels, truth.instances, std::vector<float>(40, 1.0F)};
        result.registration.emplace();
        result.registration->map_from_scan = poses;
    }

    void write(const TemporaryFolder& folder) const {
        write_truth_folder(folder / "truth", truth, scans);
        prepare_output_folder(folder / "result");
        write_registration(folder / "result", result);
        write_interpretation(folder / "result", result);
    }
};

ProgramResult evaluate(const TemporaryFolder& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"evaluate", (folder / "truth").string(),
                                       (folder / "result").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return roomscribe(arguments);
}

TEST(Evaluate, FindsTruthPerfectAndAShiftedDoorWrong) {
    const TemporaryFolder folder;
    SmallScene().write(folder);
    auto json = nlohmann::json::parse(evaluate(folder, {"--json"}).out);
    EXPECT_EQ(json.at("format"), "roomscribe-evaluation");
    EXPECT_EQ(json.at("detection").at("all").at("accuracy"), 1.0);
    EXPECT_EQ(json.at("detection").at("all").at("precision"), 1.0);
    EXPECT_EQ(json.at("points").at("mean").at("iou"), 1.0);
    EXPECT_EQ(json.at("recall").at("0.1 m, 1 deg").at("recall"), 1.0);

    SmallScene(0.4).write(folder);
    json = nlohmann::json::parse(evaluate(folder, {"--json"}).out);
    EXPECT_EQ(json.at("detection").at("door").at("accuracy"), 0.0);
    EXPECT_EQ(json.at("detection").at("door").at("false_positives"), 1);
    EXPECT_EQ(json.at("detection").at("wall").at("accuracy"), 1.0);
    EXPECT_EQ(json.at("detection").at("all").at("f1"), 0.5);
    EXPECT_EQ(json.at("matches").size(), 3U);
}

TEST(Evaluate, PrintsTablesAndCsv) {
    const TemporaryFolder folder;
    SmallScene().write(folder);
    const ProgramResult tables = evaluate(folder);
    EXPECT_EQ(tables.exit_code, 0) << tables.err;
    EXPECT_EQ(tables.err, "");
    for (const char* words : {"ground truth  correct  accuracy", "100.0 %", "recall", "axes"})
        EXPECT_THAT(tables.out, HasSubstr(words));
    const ProgramResult csv = evaluate(folder, {"--csv"});
    EXPECT_THAT(csv.out, testing::StartsWith("group,item,measure,value\n"));
    EXPECT_THAT(csv.out, HasSubstr("\ndetection,\"door\",accuracy,1\n"));
    expect_error(evaluate(folder, {"--csv", "--json"}), 2, {"--csv", "--json"});
}

TEST(Evaluate, SaysWhichFileIsWrong) {
    const TemporaryFolder folder;
    SmallScene().write(folder);
    const std::string truth = (folder / "truth").string();
    const std::string result = (folder / "result").string();
    expect_error(roomscribe({"evaluate", (folder / "none").string(), result}), 3, {"map.ply"});
    expect_error(roomscribe({"evaluate", truth, (folder / "none").string()}), 3, {"none"});
    expect_error(roomscribe({"evaluate", truth}), 2, {"RESULT"});
    expect_error(roomscribe({"evaluate", truth + "/map.ply", result}), 2, {"--convention"});
    expect_error(roomscribe({"evaluate", truth, result, "--convention", "nyu"}), 2, {"s3dis"});
    std::filesystem::remove(folder / "truth/truth/map.labels.npy");
    expect_error(evaluate(folder), 3, {"map.labels.npy"});
}

class RealLabelledHallway : public testing::TestWithParam<const char*> {};

TEST_P(RealLabelledHallway, IsScored) {
    const std::filesystem::path hallway = real_scan("rooms/s3dis/Area_3_hallway_3.ply");
    ROOMSCRIBE_REQUIRE_REAL_SCAN(hallway);
    const TemporaryFolder folder;
    ASSERT_EQ(roomscribe({GetParam(), hallway.string(), "-o", folder.path().string()}).exit_code,
              0);
    const ProgramResult result = roomscribe(
        {"evaluate", hallway.string(), folder.path().string(), "--convention", "s3dis", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("points").at("floor").at("points"), 33948);
    EXPECT_EQ(json.at("points").at("door").at("points"), 35890);
    EXPECT_GT(json.at("points").at("floor").at("iou"), 0.9);
    EXPECT_GT(json.at("points").at("ceiling").at("iou"), 0.9);
    EXPECT_EQ(json.at("detection").at("floor").at("accuracy"), 1.0);
    EXPECT_EQ(json.at("detection").at("wall").at("ground_truth"), 3);
    EXPECT_EQ(json.at("detection").at("door").at("ground_truth"), 0);
    EXPECT_LT(json.at("axes").at("up").at("max"), 1.0);
}

/// A merged map says nothing of scans, and a run of it writes poses.
INSTANTIATE_TEST_SUITE_P(Evaluate, RealLabelledHallway, testing::Values("run", "interpret"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace roomscribe::test
