// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/result_folder.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/evaluation/evaluate.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"
#include "roomscribe/pipeline/truth_folder.hpp"
#include "roomscribe/pipeline/workspace.hpp"
#include "support/matchers.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two scans with a door, far from the origin as map grids are.
struct FarScans {
    std::vector<Scan> scans{2};
    GroundTruth truth;

    FarScans() {
        scans[0].cloud.positions = {{1, 2, 3}, {2, 2, 3}};
        scans[1].cloud.positions = {{0, 0, 1}};
        Transform second = Transform::Identity();
        second.translation() = Eigen::Vector3d(1, 0, 0);
        truth.map_from_scan = {Transform::Identity(), second};
        truth.map = merge_scans(
            scans, std::vector<std::optional<Transform>>{Transform::Identity(), second});
        truth.map.cloud.global_shift = {500'000, 4'000'000, 0};
        Component door;
        door.id = "door-1";
        door.label = Label::door;
        door.polygon = {{0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {0, 0, 2}};
        door.verdict = Verdict::accepted;
        truth.scene.components = {door};
        truth.labels = {Label::wall, Label::unknown, Label::door};
        truth.instances = {3, -1, 0};
        for (const Label label : truth.labels)
            truth.acceptable.push_back(label_bit(label));
    }

    Reconstruction as_result() const {
        Reconstruction result;
        result.map = truth.map;
        result.scene = truth.scene;
        result.labels = {truth.labels, truth.instances, {0.5F, 0.0F, 1.0F}};
        result.registration.emplace();
        for (const Transform& pose : truth.map_from_scan)
            result.registration->map_from_scan.emplace_back(pose);
        RegistrationLink link;
        link.source = 1;
        link.target_from_source = truth.map_from_scan[1];
        link.verdict = LinkVerdict::accepted;
        result.registration->links = {link};
        return result;
    }
};

std::string complaint(const std::filesystem::path& folder, const GroundTruth& truth) {
    try {
        read_result_folder(folder, truth);
    } catch (const IoError& error) {
        return error.what();
    }
    return "was read";
}

TEST(ResultFolder, GivesBackWhatARunLeft) {
    const TemporaryFolder folder;
    const FarScans far;
    write_registration(folder.path(), far.as_result());
    write_interpretation(folder.path(), far.as_result());
    const Prediction prediction = read_result_folder(folder.path(), far.truth);
    EXPECT_EQ(prediction.labels->labels, far.truth.labels);
    EXPECT_EQ(prediction.labels->instances, far.truth.instances);
    EXPECT_THAT(prediction.labels->confidences, ElementsAre(0.5F, 0.0F, 1.0F));
    ASSERT_EQ(prediction.map_from_scan.size(), 2U);
    EXPECT_THAT(*prediction.map_from_scan[1],
                test::TransformNear(far.truth.map_from_scan[1], 1e-6, 1e-9));
    ASSERT_EQ(prediction.links.size(), 1U);
    EXPECT_EQ(prediction.links[0].source, 1U);
    EXPECT_TRUE(prediction.scene->components.at(0).polygon[2].isApprox(Eigen::Vector3d(1, 0, 2)));
}

TEST(ResultFolder, OfTruthScoresFullAlsoFarFromTheOrigin) {
    const TemporaryFolder folder;
    const FarScans far;
    write_truth_folder(folder / "truth", far.truth, far.scans);
    std::filesystem::create_directory(folder / "result");
    const GroundTruth truth = read_truth_folder(folder / "truth");
    EXPECT_TRUE(truth.scene.components.at(0).polygon[2].isApprox(far.truth.map.cloud.global_shift +
                                                                 Eigen::Vector3d(1, 0, 2) -
                                                                 truth.map.cloud.global_shift));
    for (const bool with_poses : {false, true}) {
        write_interpretation(folder / "result", far.as_result());
        if (with_poses) write_registration(folder / "result", far.as_result());
        const Prediction prediction = read_result_folder(folder / "result", truth);
        EXPECT_EQ(prediction.map_from_scan.empty(), !with_poses);
        const Evaluation evaluation = evaluate_result(truth, prediction);
        EXPECT_EQ(evaluation.detections->per_label[5].correct, 1U);
        EXPECT_EQ(evaluation.points->mean_iou(), 1.0);
    }
}

TEST(ResultFolder, NeedNotHoldEverything) {
    const TemporaryFolder folder;
    const FarScans far;
    EXPECT_THAT(complaint(folder.path(), far.truth), HasSubstr("holds neither"));
    EXPECT_THAT(complaint(folder / "absent", far.truth), HasSubstr("no such folder"));
    write_registration(folder.path(), far.as_result());
    EXPECT_FALSE(read_result_folder(folder.path(), far.truth).labels);
    write_interpretation(folder.path(), far.as_result());
    std::filesystem::remove(folder / "scene.json");
    EXPECT_THAT(complaint(folder.path(), far.truth), HasSubstr("scene.json"));
}

TEST(ResultFolder, MustFitTheTruth) {
    const TemporaryFolder folder;
    const FarScans far;
    write_interpretation(folder.path(), far.as_result());
    GroundTruth other = far.truth;
    other.map.cloud.positions.pop_back();
    EXPECT_THAT(complaint(folder.path(), other), HasSubstr("has 3 points and the truth 2"));
    write_registration(folder.path(), far.as_result());
    other = far.truth;
    other.map_from_scan.pop_back();
    EXPECT_THAT(complaint(folder.path(), other), HasSubstr("has 2 poses and the truth 1"));
    std::filesystem::remove(folder / "poses.txt");
    EXPECT_THAT(complaint(folder.path(), other), HasSubstr("a link of scan 1"));
    PointCloud unlabelled = far.truth.map.cloud;
    std::filesystem::remove(folder / "registration.json");
    write_point_cloud(folder / "labels.ply", unlabelled);
    EXPECT_THAT(complaint(folder.path(), far.truth), HasSubstr("no property label"));
}

TEST(LabelledCloud, TakesIntegersOfUsualTypes) {
    const TemporaryFolder folder;
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\n";
    const LabelConvention s3dis = *find_label_convention("s3dis");
    std::ofstream(folder / "a.ply") << header << "property uchar label\nproperty ushort instance\n"
                                    << "end_header\n0 0 0 2 7\n1 0 0 1 40000\n2 0 0 12 1\n";
    const GroundTruth truth = read_labelled_cloud(folder / "a.ply", s3dis);
    EXPECT_THAT(truth.labels, ElementsAre(Label::wall, Label::floor, Label::unknown));
    EXPECT_EQ(truth.scene.components.size(), 2U);
    std::ofstream(folder / "b.ply") << header << "property int class\nend_header\n"
                                    << "0 0 0 2\n1 0 0 1\n2 0 0 -5\n";
    EXPECT_EQ(read_labelled_cloud(folder / "b.ply", s3dis).labels[0], Label::wall);
    std::ofstream(folder / "c.ply") << header << "end_header\n0 0 0\n1 0 0\n2 0 0\n";
    EXPECT_THROW(read_labelled_cloud(folder / "c.ply", s3dis), IoError);
    std::ofstream(folder / "d.ply") << header << "property float label\nend_header\n"
                                    << "0 0 0 2\n1 0 0 1\n2 0 0 1\n";
    EXPECT_THROW(read_labelled_cloud(folder / "d.ply", s3dis), IoError);
}

}  // namespace
}  // namespace roomscribe
