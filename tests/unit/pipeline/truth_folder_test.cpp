// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/truth_folder.hpp"

#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/npy.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "support/matchers.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

constexpr LabelSet set_of(std::initializer_list<Label> labels) {
    unsigned all = 0;
    for (const Label label : labels)
        all |= label_bit(label);
    return static_cast<LabelSet>(all);
}

/// Two scans: a floor point and a lost ray, then two points of a column.
struct TwoScans {
    std::vector<Scan> scans{2};
    GroundTruth truth;

    TwoScans() {
        scans[0].cloud.positions = {{1, 2, 3}, {nan, nan, nan}};
        scans[1].cloud.positions = {{0, 0, 1}, {0, 1, 1}};
        Transform second = Transform::Identity();
        second.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
        second.translation() = Eigen::Vector3d(1, 0, 0);
        truth.map_from_scan = {Transform::Identity(), second};
        truth.map = merge_scans(
            scans, std::vector<std::optional<Transform>>{Transform::Identity(), second});
        Component floor;
        floor.id = "floor-1";
        floor.label = Label::floor;
        floor.instance = 4;
        floor.polygon = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
        floor.visible = 0.75;
        floor.verdict = Verdict::accepted;
        Component column = floor;
        column.id = "column-1";
        column.label = Label::unknown;
        column.kind = "column";
        column.instance = 5;
        truth.scene.components = {floor, column};
        truth.labels = {Label::floor, Label::unknown, Label::unknown, Label::wall};
        truth.instances = {4, -1, 5, 5};
        truth.acceptable = {set_of({Label::floor, Label::furniture}), set_of({Label::unknown}),
                            set_of({Label::unknown, Label::wall}), set_of({Label::wall})};
    }
};

/// The message of the IoError that reading the folder throws.
std::string complaint(const std::filesystem::path& folder) {
    try {
        read_truth_folder(folder);
    } catch (const IoError& error) {
        return error.what();
    }
    return "was read";
}

TEST(TruthFolder, GivesBackWhatWasWritten) {
    const TemporaryFolder folder;
    const TwoScans two;
    write_truth_folder(folder / "a/b", two.truth, two.scans);
    for (const char* name :
         {"scans/000.ply", "scans/001.ply", "map.ply", "truth/poses.txt", "truth/scene.json",
          "truth/000.labels.npy", "truth/001.labels.npy", "truth/map.labels.npy",
          "truth/map.instances.npy", "truth/map.acceptable.npy"}) {
        EXPECT_TRUE(std::filesystem::is_regular_file(folder / "a/b" / name)) << name;
    }
    EXPECT_THAT(read_npy<std::uint8_t>(folder / "a/b/truth/001.labels.npy"), ElementsAre(0, 3));

    const GroundTruth read = read_truth_folder(folder / "a/b");
    EXPECT_EQ(read.labels, two.truth.labels);
    EXPECT_EQ(read.instances, two.truth.instances);
    EXPECT_EQ(read.acceptable, two.truth.acceptable);
    ASSERT_EQ(read.map.cloud.size(), 4U);
    EXPECT_EQ(read.map.cloud.positions[3], two.truth.map.cloud.positions[3]);
    ASSERT_EQ(read.map.sections.size(), 2U);
    EXPECT_EQ(read.map.sections[1].first, 2U);
    EXPECT_EQ(read.map.sections[1].count, 2U);
    EXPECT_EQ(read.map.sections[1].sensor_position, Eigen::Vector3d(1, 0, 0));
    ASSERT_EQ(read.map_from_scan.size(), 2U);
    EXPECT_THAT(read.map_from_scan[1],
                test::TransformNear(two.truth.map_from_scan[1], 1e-12, 1e-12));
    ASSERT_EQ(read.scene.components.size(), 2U);
    EXPECT_EQ(read.scene.components[0].visible, 0.75);
    EXPECT_EQ(read.scene.components[1].kind, "column");
}

TEST(TruthFolder, LeavesNothingOfALongerSceneThatWasThereBefore) {
    const TemporaryFolder folder;
    const TwoScans two;
    write_truth_folder(folder.path(), two.truth, two.scans);
    GroundTruth one = two.truth;
    const std::vector<Scan> scans{two.scans[0]};
    one.map_from_scan.resize(1);
    one.map = merge_scans(scans, std::vector<std::optional<Transform>>{Transform::Identity()});
    one.labels.resize(2);
    one.instances.resize(2);
    one.acceptable.resize(2);
    write_truth_folder(folder.path(), one, scans);
    EXPECT_TRUE(std::filesystem::exists(folder / "scans/000.ply"));
    EXPECT_FALSE(std::filesystem::exists(folder / "scans/001.ply"));
    EXPECT_FALSE(std::filesystem::exists(folder / "truth/001.labels.npy"));
    EXPECT_EQ(read_truth_folder(folder.path()).map.sections.size(), 1U);
}

TEST(TruthFolder, ReadsWhatAnotherProgramWroteWithoutOurAdditions) {
    const TemporaryFolder folder;
    const TwoScans two;
    write_truth_folder(folder.path(), two.truth, two.scans);
    std::filesystem::remove(folder / "truth/map.acceptable.npy");
    std::filesystem::remove(folder / "truth/001.labels.npy");
    std::ofstream(folder / "truth/scene.json") << R"({"format": "roomscribe-scene", "version": 1,
        "made_by": "another", "components": [{"id": "c", "label": "unknown", "kind": "round column",
        "instance": 5, "visible": 1, "mood": {"x": [1]}}]})";
    const GroundTruth read = read_truth_folder(folder.path());
    // Instance 4 has no component; both points of the column may be wall or unknown.
    EXPECT_THAT(read.acceptable, ElementsAre(set_of({Label::floor}), set_of({Label::unknown}),
                                             set_of({Label::unknown, Label::wall}),
                                             set_of({Label::unknown, Label::wall})));
    ASSERT_EQ(read.map.sections.size(), 1U);
    EXPECT_EQ(read.map.sections[0].count, 4U);
}

TEST(TruthFolder, KindsWidenWhatIsRight) {
    EXPECT_EQ(acceptable_labels(Label::unknown, "column"), set_of({Label::unknown, Label::wall}));
    EXPECT_EQ(acceptable_labels(Label::ceiling, "beam"),
              set_of({Label::unknown, Label::wall, Label::ceiling}));
    EXPECT_EQ(acceptable_labels(Label::wall, "door_lining"),
              set_of({Label::wall, Label::door_frame}));
    EXPECT_EQ(acceptable_labels(Label::wall, "reveal"), set_of({Label::wall, Label::window_frame}));
    EXPECT_EQ(acceptable_labels(Label::furniture, "table"), set_of({Label::furniture}));
    EXPECT_EQ(acceptable_labels(Label::unknown, ""), set_of({Label::unknown}));
}

TEST(TruthFolder, AlwaysAcceptsThePointsOwnLabel) {
    const TemporaryFolder folder;
    const TwoScans two;
    write_truth_folder(folder.path(), two.truth, two.scans);
    const std::vector<LabelSet> nothing(4, 0);
    write_npy(folder / "truth/map.acceptable.npy", std::span<const LabelSet>(nothing));
    EXPECT_EQ(read_truth_folder(folder.path()).acceptable[0], set_of({Label::floor}));
}

TEST(TruthFolder, SaysWhatDoesNotFit) {
    const TemporaryFolder folder;
    const TwoScans two;
    write_truth_folder(folder.path(), two.truth, two.scans);
    const auto with_bytes = [&](const char* name, std::vector<std::uint8_t> bytes) {
        write_truth_folder(folder.path(), two.truth, two.scans);
        write_npy(folder / name, std::span<const std::uint8_t>(bytes));
        return complaint(folder.path());
    };
    EXPECT_EQ(complaint(folder.path()), "was read");
    EXPECT_THAT(with_bytes("truth/map.labels.npy", {1, 0, 0}), HasSubstr("3 elements for the 4"));
    EXPECT_THAT(with_bytes("truth/map.labels.npy", {1, 0, 0, 10}), HasSubstr("10 is not a label"));
    EXPECT_THAT(with_bytes("truth/000.labels.npy", {1, 0, 0}), HasSubstr("scans are 5"));
    EXPECT_THAT(with_bytes("truth/map.instances.npy", {1, 0, 0, 0}), HasSubstr("'<i4'"));
    write_truth_folder(folder.path(), two.truth, two.scans);
    write_poses(folder / "truth/poses.txt",
                std::vector<std::optional<Transform>>{Transform::Identity(), std::nullopt});
    EXPECT_THAT(complaint(folder.path()), HasSubstr("scan 1 has no pose"));
    EXPECT_THAT(complaint(folder / "absent"), HasSubstr("map.ply"));
}

TEST(TruthFolder, RefusesToWriteWhatDoesNotFitTogether) {
    const TemporaryFolder folder;
    TwoScans two;
    two.truth.acceptable.pop_back();
    EXPECT_THROW(write_truth_folder(folder.path(), two.truth, two.scans), InvalidArgument);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    std::ofstream(folder / "file") << "x";
    EXPECT_THROW(write_truth_folder(folder / "file", TwoScans().truth, two.scans), IoError);
}

}  // namespace
}  // namespace roomscribe
