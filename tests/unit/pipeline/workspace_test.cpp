// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/workspace.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "roomscribe/pipeline/file_hash.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    return names;
}

std::string content_of(const std::filesystem::path& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

std::vector<Scan> two_scans() {
    std::vector<Scan> scans(2);
    scans[0].name = "a.ply";
    scans[0].cloud.positions = {{1, 2, 3}, {nan, nan, nan}};
    scans[1].name = "b.ply";
    scans[1].cloud.positions = {{0, 0, 1}};
    return scans;
}

Reconstruction registered(const std::vector<Scan>& scans) {
    Reconstruction result;
    Transform shifted = Transform::Identity();
    shifted.translation() = Eigen::Vector3d(1, 0, 0);
    result.registration.emplace();
    result.registration->map_from_scan = {Transform::Identity(), shifted};
    result.map = merge_scans(scans, result.registration->map_from_scan);
    return result;
}

void label_all(Reconstruction& result) {
    result.labels.labels = {Label::wall, Label::unknown, Label::handle};
    result.labels.instances = {7, -1, 9};
    result.labels.confidences = {0.5F, 0.0F, 1.0F};
}

template <typename Value>
std::vector<Value> channel_of(const PointCloud& cloud, const std::string& name, ScalarType type) {
    for (const Channel& channel : cloud.channels) {
        if (channel.name != name || channel.type != type) continue;
        std::vector<Value> values(channel.values.size() / sizeof(Value));
        std::memcpy(values.data(), channel.values.data(), channel.values.size());
        return values;
    }
    ADD_FAILURE() << "no channel " << name;
    return {};
}

TEST(PrepareOutputFolder, MakesItWithParentsAndLeavesNothingInIt) {
    const TemporaryFolder temporary;
    prepare_output_folder(temporary / "a/b");
    prepare_output_folder(temporary / "a/b");
    EXPECT_TRUE(std::filesystem::is_empty(temporary / "a/b"));
}

TEST(PrepareOutputFolder, RefusesWhatCannotHoldFiles) {
    const TemporaryFolder temporary;
    std::ofstream(temporary / "file") << "x";
    EXPECT_THROW(prepare_output_folder(temporary / "file"), IoError);
    EXPECT_THROW(prepare_output_folder(temporary / "file/below"), IoError);
    EXPECT_THROW(prepare_output_folder("/proc/roomscribe"), IoError);
}

TEST(PrepareOutputFolder, RefusesAFolderWithoutWritePermission) {
    if (::geteuid() == 0) GTEST_SKIP() << "nothing is forbidden to root";
    const TemporaryFolder temporary;
    std::filesystem::permissions(
        temporary.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    EXPECT_THROW(prepare_output_folder(temporary.path()), IoError);
    std::filesystem::permissions(temporary.path(), std::filesystem::perms::owner_all);
}

TEST(WriteRegistration, LeavesThreeWholeFiles) {
    const TemporaryFolder folder;
    const std::vector<Scan> scans = two_scans();
    write_registration(folder.path(), registered(scans));
    EXPECT_THAT(names_in(folder.path()),
                UnorderedElementsAre("poses.txt", "registration.json", "map.ply"));

    const auto poses = read_poses(folder / "poses.txt");
    ASSERT_EQ(poses.size(), 2U);
    EXPECT_EQ(poses[1]->translation(), Eigen::Vector3d(1, 0, 0));
    const PointCloud map = read_scan(folder / "map.ply").cloud;
    ASSERT_EQ(map.size(), 3U);
    EXPECT_TRUE(std::isnan(map.positions[1].x()));
    EXPECT_EQ(map.positions[2], Eigen::Vector3f(1, 0, 1));
    EXPECT_THAT(content_of(folder / "registration.json"), HasSubstr("\"name\": \"b.ply\""));
}

TEST(WriteRegistration, WritesPosesBetweenFileCoordinates) {
    const TemporaryFolder folder;
    std::vector<Scan> scans = two_scans();
    scans[0].cloud.global_shift = {5000, 0, 0};
    scans[1].cloud.global_shift = {0, 300, 0};
    write_registration(folder.path(), registered(scans));
    const auto poses = read_poses(folder / "poses.txt");
    EXPECT_TRUE(poses[0]->isApprox(Transform::Identity()));
    // A point of file b at its shift lies 1 m from the shift of the map's first scan.
    EXPECT_TRUE((*poses[1] * Eigen::Vector3d(0, 300, 0)).isApprox(Eigen::Vector3d(5001, 0, 0)));
}

TEST(RemoveApartFrom, TakesAwayWhatAnEarlierRunLeftAndNothingElse) {
    const TemporaryFolder folder;
    for (const char* name : {"set-2", "set-3", "set-4"})
        std::filesystem::create_directories(folder / name);
    std::ofstream(folder / "set-2/run.json") << "{}";
    std::ofstream(folder / "set-3/run.json") << "{}";
    std::ofstream(folder / "set-4/notes.txt") << "mine";
    remove_apart_from(folder.path(), 1);
    EXPECT_EQ(folder_of_apart(0), "set-2");
    EXPECT_THAT(names_in(folder.path()), UnorderedElementsAre("set-2", "set-4"));
    // Corrections are the user's.
    std::ofstream(folder / "set-2/corrections.json") << "{}";
    remove_apart_from(folder.path(), 0);
    EXPECT_THAT(names_in(folder / "set-2"), UnorderedElementsAre("corrections.json"));
}

TEST(WriteRegistration, NeedsAPoseSlotPerScan) {
    const TemporaryFolder folder;
    Reconstruction result = registered(two_scans());
    result.registration->map_from_scan.pop_back();
    EXPECT_THROW(write_registration(folder.path(), result), InvalidArgument);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteInterpretation, KeepsEveryPointInItsPlace) {
    const TemporaryFolder folder;
    Reconstruction result = registered(two_scans());
    label_all(result);
    write_interpretation(folder.path(), result);
    EXPECT_THAT(names_in(folder.path()), UnorderedElementsAre("labels.ply", "scene.json"));

    const PointCloud cloud = read_scan(folder / "labels.ply").cloud;
    ASSERT_EQ(cloud.size(), 3U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1, 2, 3));
    EXPECT_TRUE(std::isnan(cloud.positions[1].x()));
    EXPECT_EQ(channel_of<std::uint8_t>(cloud, "label", ScalarType::uint8),
              (std::vector<std::uint8_t>{3, 0, 9}));
    EXPECT_EQ(channel_of<std::int32_t>(cloud, "instance", ScalarType::int32),
              (std::vector<std::int32_t>{7, -1, 9}));
    EXPECT_EQ(channel_of<float>(cloud, "confidence", ScalarType::float32),
              (std::vector<float>{0.5F, 0.0F, 1.0F}));
}

TEST(WriteInterpretation, CarriesChannelsThroughAndRenamesALabelOfTheInput) {
    const TemporaryFolder folder;
    Reconstruction result = registered(two_scans());
    label_all(result);
    const auto bytes = [](std::initializer_list<int> values) {
        std::vector<std::byte> result_bytes;
        for (const int value : values)
            result_bytes.push_back(static_cast<std::byte>(value));
        return result_bytes;
    };
    result.map.cloud.intensities = {0.25F, 0.5F, 0.75F};
    result.map.cloud.channels = {{"ring", ScalarType::uint8, 1, bytes({1, 2, 3})},
                                 {"label", ScalarType::uint8, 1, bytes({4, 5, 6})}};
    write_interpretation(folder.path(), result);
    const PointCloud cloud = read_scan(folder / "labels.ply").cloud;
    EXPECT_EQ(cloud.intensities, (std::vector<float>{0.25F, 0.5F, 0.75F}));
    EXPECT_EQ(channel_of<std::uint8_t>(cloud, "ring", ScalarType::uint8),
              (std::vector<std::uint8_t>{1, 2, 3}));
    EXPECT_EQ(channel_of<std::uint8_t>(cloud, "input_label", ScalarType::uint8),
              (std::vector<std::uint8_t>{4, 5, 6}));
    EXPECT_EQ(channel_of<std::uint8_t>(cloud, "label", ScalarType::uint8),
              (std::vector<std::uint8_t>{3, 0, 9}));
}

TEST(WriteInterpretation, WritesTheSceneInFileCoordinates) {
    const TemporaryFolder folder;
    Reconstruction result = registered(two_scans());
    label_all(result);
    result.map.cloud.global_shift = {1000, 2000, 0};
    Component wall;
    wall.id = "wall-1";
    wall.label = Label::wall;
    wall.polygon = {{1, 0, 0}, {2, 0, 0}, {2, 0, 2}, {1, 0, 2}};
    result.scene.components = {wall};
    result.scene.room_from_map.translation() = Eigen::Vector3d(0.5, 0, 0);
    write_interpretation(folder.path(), result);
    const Scene scene = scene_from_json(content_of(folder / "scene.json"));
    EXPECT_EQ(scene.components[0].polygon[1], Eigen::Vector3d(1002, 2000, 0));
    EXPECT_TRUE((scene.room_from_map * Eigen::Vector3d(1001, 2000, 0))
                    .isApprox(Eigen::Vector3d(1.5, 0, 0), 1e-9));
}

TEST(WriteInterpretation, NeedsALabelForEveryPoint) {
    const TemporaryFolder folder;
    Reconstruction result = registered(two_scans());
    label_all(result);
    result.labels.confidences.pop_back();
    EXPECT_THROW(write_interpretation(folder.path(), result), InvalidArgument);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteInterpretation, LeavesAnOlderFileWholeWhenItFails) {
    const TemporaryFolder folder;
    Reconstruction result = registered(two_scans());
    label_all(result);
    write_interpretation(folder.path(), result);
    const std::string before = content_of(folder / "scene.json");
    result.scene.room_from_map.translation().x() = std::nan("");
    EXPECT_THROW(write_interpretation(folder.path(), result), InvalidArgument);
    EXPECT_EQ(content_of(folder / "scene.json"), before);
    EXPECT_THAT(names_in(folder.path()), UnorderedElementsAre("labels.ply", "scene.json"));
}

TEST(RunToJson, NestsSettingsAndKeepsTheirTypes) {
    RunRecord record;
    record.version = "1.2.3";
    record.command = "run";
    record.num_threads = 4;
    record.settings = {{"seed", "", "", "7", "", false},
                       {"icp.kernel.scale", "m", "", "0.25", "", false},
                       {"icp.kernel.kind", "", "", "huber", "", true},
                       {"icp.robust", "", "", "true", "", false}};
    record.inputs = {{"scans/\"a\".ply", 300, 0x1FULL}};
    record.results = {{"scene.json", 7, 2, FileRole::result}};
    Reconstruction result;
    result.stage_costs = {{"read", 0.5, 1024}};
    result.derived_values = {{"voxel_size", 0.02, "m", "spacing"}};
    EXPECT_EQ(run_to_json(record, result), R"({
  "format": "roomscribe-run",
  "version": 1,
  "program_version": "1.2.3",
  "command": "run",
  "threads": 4,
  "inputs": [
    {
      "path": "scans/\"a\".ply",
      "role": "scan",
      "size": 300,
      "xxh64": "000000000000001f"
    }
  ],
  "results": [
    {
      "path": "scene.json",
      "role": "result",
      "size": 7,
      "xxh64": "0000000000000002"
    }
  ],
  "settings": {
    "seed": 7,
    "icp": {
      "kernel": {
        "scale": 0.25,
        "kind": "huber"
      },
      "robust": true
    }
  },
  "derived_values": [
    {
      "name": "voxel_size",
      "value": 0.02,
      "unit": "m",
      "reason": "spacing"
    }
  ],
  "stages": [
    {
      "stage": "read",
      "seconds": 0.5,
      "peak_memory": 1024
    }
  ]
}
)");
}

TEST(HashBytes, GivesTheValuesOfTheReferenceImplementation) {
    const auto hash = [](std::string_view text) {
        return hash_bytes(std::as_bytes(std::span(text)));
    };
    EXPECT_EQ(hash(""), 0xEF46DB3751D8E999ULL);
    EXPECT_EQ(hash("a"), 0xD24EC4F1A98C6E5BULL);
    EXPECT_EQ(hash("abc"), 0x44BC2CF5AD770999ULL);
    EXPECT_EQ(hash("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1ULL);
}

TEST(DescribeInput, HashesAFileAsItsBytes) {
    const TemporaryFolder folder;
    std::string bytes(3'000'017, 'x');
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<char>(i * i % 251);
    std::ofstream(folder / "scan.bin", std::ios::binary) << bytes;
    const FileRecord input = describe_input(folder / "scan.bin");
    EXPECT_EQ(input.size, bytes.size());
    EXPECT_EQ(input.xxh64, hash_bytes(std::as_bytes(std::span(bytes))));
    EXPECT_THROW(describe_input(folder / "absent"), IoError);
    EXPECT_THROW(describe_input(folder.path()), IoError);
}

TEST(DescribeResults, ListsTheFilesThatAreThere) {
    const TemporaryFolder folder;
    EXPECT_TRUE(describe_results(folder.path()).empty());
    Reconstruction result = registered(two_scans());
    label_all(result);
    write_interpretation(folder.path(), result);
    const std::vector<FileRecord> files = describe_results(folder.path());
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files[0].path, "labels.ply");
    EXPECT_EQ(files[1].path, "scene.json");
    EXPECT_EQ(files[1].xxh64, hash_file(folder / "scene.json"));
    EXPECT_EQ(files[1].role, FileRole::result);
}

}  // namespace
}  // namespace roomscribe
