// SPDX-License-Identifier: MIT
// Scans of every format through the whole program.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/e57.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;

/// What interpret finds in a file, or several.
nlohmann::json interpret(const std::filesystem::path& folder,
                         const std::vector<std::string>& arguments) {
    const std::string out = (folder / "out").string();
    std::vector<std::string> all = {"interpret"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"-o", out, "--progress", "none"});
    const ProgramResult result = roomscribe(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_json(folder / "out" / "scene.json");
}

TEST(Formats, ConvertInfoInterpretGiveTheSameRoom) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const std::size_t num_points = finite_points(read_scan(scan).cloud).size();
    const nlohmann::json expected = interpret(folder.path(), {scan});
    ASSERT_GT(count_components(expected, "wall"), 0U);
    for (const char* name : {"a.e57", "a.las", "a.xyz", "a.csv"}) {
        SCOPED_TRACE(name);
        const std::string path = (folder / name).string();
        ASSERT_EQ(roomscribe({"convert", scan, path}).exit_code, 0);
        const auto info = nlohmann::json::parse(roomscribe({"info", path, "--json"}).out);
        ASSERT_EQ(info.size(), 1U);
        EXPECT_EQ(
            info[0].at("points").get<std::size_t>() - info[0].at("non_finite").get<std::size_t>(),
            num_points);
        const nlohmann::json found = interpret(folder.path(), {path});
        for (const char* label : {"floor", "ceiling", "wall"}) {
            EXPECT_EQ(count_components(found, label), count_components(expected, label)) << label;
        }
    }
}

/// Two scans that stand as the simulation says, in one file and far away.
std::vector<StoredScan> write_e57_of_two(const std::filesystem::path& folder) {
    std::vector<StoredScan> scans;
    double turn = 0.3;
    for (const std::string& path : write_room_scans(folder, 2)) {
        Transform pose = Transform::Identity();
        pose.rotate(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
        pose.translation() = Eigen::Vector3d(turn, 2.0, 1.0);
        scans.push_back({read_scan(path), pose, Eigen::Vector3d(4.5e6, 5.4e6, 0.0)});
        scans.back().scan.cloud.sensor_pose.reset();
        turn += 0.01;
    }
    write_e57(folder / "building.e57", scans, {});
    return scans;
}

TEST(Formats, InterpretTakesThePosesOfTheFile) {
    const TemporaryFolder folder;
    const std::vector<StoredScan> scans = write_e57_of_two(folder.path());
    const std::string path = (folder / "building.e57").string();
    interpret(folder.path(), {path});
    const PointCloud labelled = read_scan(folder / "out" / "labels.ply").cloud;
    ASSERT_EQ(labelled.size(), scans[0].scan.cloud.size() + scans[1].scan.cloud.size());
    // The map is in the file's far coordinates.
    for (std::size_t i = 0; i < labelled.size(); ++i) {
        const std::size_t first = scans[0].scan.cloud.size();
        const StoredScan& stored = scans[i < first ? 0 : 1];
        const Eigen::Vector3f& point = stored.scan.cloud.positions[i < first ? i : i - first];
        if (!is_finite(point)) continue;
        const Eigen::Vector3d expected =
            *stored.map_from_scan * point.cast<double>() + stored.map_shift;
        const Eigen::Vector3d found = labelled.positions[i].cast<double>() + labelled.global_shift;
        ASSERT_LT((found - expected).norm(), 1e-4);
    }
    // Poses that are given by hand win.
    write_poses(folder / "poses.txt",
                std::vector<std::optional<Transform>>(2, std::optional(Transform::Identity())));
    interpret(folder.path(), {path, "--poses", (folder / "poses.txt").string()});
    EXPECT_TRUE(read_scan(folder / "out" / "labels.ply").cloud.global_shift.isZero(0.0));
}

TEST(Formats, InfoTellsOfEveryScan) {
    const TemporaryFolder folder;
    write_e57_of_two(folder.path());
    const std::string path = (folder / "building.e57").string();
    const std::string text = roomscribe({"info", path}).out;
    for (const char* word : {"scan 1 of 2: scan1.ply", "scan 2 of 2", "4500000.300 5400002.000",
                             "degrees about", "cartesianX float32"}) {
        EXPECT_THAT(text, HasSubstr(word));
    }
    const auto json = nlohmann::json::parse(roomscribe({"info", path, "--json"}).out);
    ASSERT_EQ(json.size(), 2U);
    EXPECT_NEAR(json[1].at("pose").at(0).at(3).get<double>(), 4500000.31, 1e-9);
    std::ofstream(folder / "a.csv") << "X;Y;Z;R;G;B\n1;2;3;4;5;6\n";
    EXPECT_THAT(roomscribe({"info", (folder / "a.csv").string()}).out,
                HasSubstr("x y z red green blue"));
}

TEST(Formats, RunFindsThePosesOfScansInOneFile) {
    const TemporaryFolder folder;
    write_e57_of_two(folder.path());
    const std::string out = (folder / "out").string();
    const ProgramResult result =
        roomscribe({"register", (folder / "building.e57").string(), "-o", out});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(read_poses(folder / "out" / "poses.txt").size(), 2U);
    const std::string text = read_json(folder / "out" / "registration.json").dump();
    EXPECT_THAT(text, HasSubstr("building.e57#scan2.ply"));
}

TEST(Formats, SeveralScansWithoutPosesAreNoMap) {
    const TemporaryFolder folder;
    const auto paths = write_room_scans(folder.path(), 2);
    expect_error(roomscribe({"interpret", paths[0], paths[1], "-o", (folder / "out").string()}), 2,
                 {"--poses"});
}

/// A setting before or behind the files is no file.
TEST(Formats, SettingsBesideFilesAreNoFiles) {
    const TemporaryFolder folder;
    const std::string absent = (folder / "absent.las").string();
    for (const auto& arguments : std::vector<std::vector<std::string>>{
             {"explain", "--set", "seed=3", absent},
             {"explain", absent, "--set", "seed=3"},
             {"explain", "--set", "seed=3", "--set", "seed=4", absent},
             {"interpret", "--set", "seed=3", absent, "-o", (folder / "out").string()},
             {"run", "-o", (folder / "out").string(), "--set=seed=3", absent}}) {
        expect_error(roomscribe(arguments), 3, {"absent.las"});
    }
}

}  // namespace
}  // namespace roomscribe::test
