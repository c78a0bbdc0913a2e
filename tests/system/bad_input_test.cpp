// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

constexpr std::size_t memory_bound = std::size_t{300} << 20U;

std::string pcd_header(const std::string& num_points, const std::string& data) {
    return fmt::format(
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA {1}\n",
        num_points, data);
}

std::string ply_header(const std::string& num_points) {
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nend_header\n",
        num_points);
}

std::string points_in_place(int count, const std::string& point) {
    std::string text = pcd_header(std::to_string(count), "ascii");
    for (int i = 0; i < count; ++i)
        text += point + "\n";
    return text;
}

std::string rubbish() {
    Random random(1);
    std::string bytes;
    for (int i = 0; i < 5000; ++i)
        bytes += static_cast<char>(random.below(256));
    return bytes;
}

struct BadFile {
    std::string test_name;
    std::string file_name;
    std::string content;
    bool has_place;  ///< the message must name a byte or a line
};

void PrintTo(const BadFile& bad, std::ostream* stream) {
    *stream << bad.test_name;
}

class BadInput : public testing::TestWithParam<BadFile> {};

TEST_P(BadInput, GetsOneClearLineAndLeavesNothing) {
    const TemporaryFolder folder;
    const BadFile& bad = GetParam();
    const std::string path = (folder / bad.file_name).string();
    std::ofstream(path, std::ios::binary) << bad.content;
    const std::string good = write_room_scans(folder.path(), 1).front();
    const std::string out = (folder / "deep" / "out").string();

    for (const std::vector<std::string>& job :
         {std::vector<std::string>{"run", good, path, "-o", out},
          std::vector<std::string>{"register", path, good, "-o", out},
          std::vector<std::string>{"interpret", path, "-o", out},
          std::vector<std::string>{"explain", path}}) {
        const ProgramResult result = roomscribe(job);
        expect_error(result, 3, {bad.file_name, "; "});
        if (bad.has_place) {
            EXPECT_THAT(result.err, testing::ContainsRegex(", (byte|line) [0-9]+"));
        }
        EXPECT_LT(result.peak_memory, memory_bound);
        EXPECT_FALSE(std::filesystem::exists(folder / "deep"));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadInput,
    testing::Values(
        BadFile{"EmptyPcd", "bad.pcd", "", false}, BadFile{"EmptyPly", "bad.ply", "", false},
        BadFile{"EmptyUos", "bad.3d", "", false}, BadFile{"RubbishPcd", "bad.pcd", rubbish(), true},
        BadFile{"RubbishPly", "bad.ply", rubbish(), true},
        BadFile{"RubbishUos", "bad.3d", rubbish(), true},
        BadFile{"UnknownFormat", "bad.xyzzy", rubbish(), false},
        BadFile{"TruncatedHeader", "bad.pcd", pcd_header("500", "ascii").substr(0, 60), true},
        BadFile{"TruncatedAscii", "bad.pcd", pcd_header("500", "ascii") + "1 2 3\n1 2", true},
        BadFile{"TruncatedBinary", "bad.pcd",
                pcd_header("500", "binary") + rubbish().substr(0, 700), true},
        BadFile{"TruncatedCompressed", "bad.pcd",
                pcd_header("500", "binary_compressed") + rubbish().substr(0, 6), true},
        BadFile{"TruncatedPly", "bad.ply", ply_header("500") + rubbish().substr(0, 700), true},
        BadFile{"PromisesTooMuchAscii", "bad.pcd", pcd_header("1000000000000", "ascii") + "1 2 3\n",
                true},
        BadFile{"PromisesTooMuchBinary", "bad.pcd",
                pcd_header("1000000000000", "binary") + rubbish(), true},
        BadFile{"PromisesTooMuchCompressed", "bad.pcd",
                pcd_header("1000000000000", "binary_compressed") + rubbish(), true},
        BadFile{"PromisesTooMuchPly", "bad.ply", ply_header("1000000000000") + rubbish(), true},
        BadFile{"ThreePoints", "bad.pcd", pcd_header("3", "ascii") + "0 0 0\n1 0 0\n0 1 0\n",
                false},
        BadFile{"NoPoints", "bad.ply", ply_header("0"), false},
        BadFile{"AllPointsEqual", "bad.pcd", points_in_place(500, "1.5 2 3"), false},
        BadFile{"AllPointsNan", "bad.pcd", points_in_place(500, "nan nan nan"), false}),
    [](const auto& tested) { return tested.param.test_name; });

TEST(BadPath, MissingFileIsNamed) {
    const TemporaryFolder folder;
    const std::string missing = (folder / "missing.pcd").string();
    const std::string out = (folder / "out").string();
    expect_error(roomscribe({"run", missing, "-o", out}), 3, {missing});
    expect_error(roomscribe({"info", missing}), 3, {missing});
    expect_error(roomscribe({"convert", missing, out + ".ply"}), 3, {missing});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(BadPath, FolderIsRefused) {
    const TemporaryFolder folder;
    for (const char* name : {"scans", "scans.pcd", "scans.ply"}) {
        const std::filesystem::path path = folder / name;
        std::filesystem::create_directory(path);
        expect_error(roomscribe({"info", path.string()}), 3, {path.string()});
        expect_error(roomscribe({"interpret", path.string(), "-o", (folder / "out").string()}), 3,
                     {path.string()});
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(BadPath, UnreadableFileIsNamed) {
    if (geteuid() == 0) GTEST_SKIP() << "root reads every file";
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    std::filesystem::permissions(scan, std::filesystem::perms::none);
    expect_error(roomscribe({"info", scan}), 3, {scan});
}

TEST(BadPath, PosesThatDoNotFitTheScansAreRefused) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const std::string out = (folder / "out").string();
    const std::string poses = (folder / "poses.txt").string();
    const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0\n";
    std::ofstream(poses) << identity << identity;
    expect_error(roomscribe({"interpret", scan, "--poses", poses, "-o", out}), 3,
                 {poses, "2", "1"});
    std::ofstream(poses) << identity << "1 2 3\n";
    expect_error(roomscribe({"interpret", scan, "--poses", poses, "-o", out}), 3,
                 {poses, "line 2"});
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(PointsWithoutPlace, StayWhereTheyAreAndAreUnknown) {
    const TemporaryFolder folder;
    const std::string path = write_room_scans(folder.path(), 1).front();
    Scan scan = read_scan(path);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < scan.cloud.size(); i += 10) {
        const float bad = i % 20 == 0 ? std::nanf("") : infinity;
        scan.cloud.positions[i][static_cast<Eigen::Index>(i / 10 % 3)] = bad;
    }
    write_point_cloud(path, scan.cloud);

    ASSERT_EQ(roomscribe({"interpret", path, "-o", (folder / "out").string()}).exit_code, 0);
    const PointCloud labelled = read_scan(folder / "out" / "labels.ply").cloud;
    ASSERT_EQ(labelled.size(), scan.cloud.size());
    const auto label = std::find_if(labelled.channels.begin(), labelled.channels.end(),
                                    [](const Channel& channel) { return channel.name == "label"; });
    ASSERT_NE(label, labelled.channels.end());
    std::size_t num_labelled = 0;
    for (std::size_t i = 0; i < labelled.size(); ++i) {
        const bool finite = is_finite(scan.cloud.positions[i]);
        ASSERT_EQ(is_finite(labelled.positions[i]), finite) << i;
        if (finite) {
            num_labelled += label->values[i] != std::byte{0} ? 1U : 0U;
        } else {
            ASSERT_EQ(label->values[i], std::byte{0}) << i;
        }
    }
    EXPECT_GT(num_labelled, labelled.size() / 3);
}

}  // namespace
}  // namespace roomscribe::test
