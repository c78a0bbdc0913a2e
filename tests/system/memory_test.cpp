// SPDX-License-Identifier: MIT
#include <fstream>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "support/simulated_rooms.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

TEST(Memory, ABoundIsKeptAndChangesNoResult) {
    const TemporaryFolder folder;
    std::vector<std::string> arguments{"run"};
    for (const Scan& scan : scan_furnished_room(1, 16.0)) {
        arguments.push_back((folder / scan.name).string());
        write_point_cloud(arguments.back(), scan.cloud);
    }
    const auto run = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> all = arguments;
        all.insert(all.end(), {"-o", (folder / name).string()});
        all.insert(all.end(), more.begin(), more.end());
        return roomscribe(all);
    };
    ASSERT_EQ(run("free", {}).exit_code, 0);
    const ProgramResult bounded = run("bounded", {"--memory", "512M"});
    ASSERT_EQ(bounded.exit_code, 0) << bounded.err;
    EXPECT_LT(bounded.peak_memory, std::size_t{512} << 20U);
    for (const char* file : {"map.ply", "labels.ply", "poses.txt", "scene.json"})
        EXPECT_EQ(read_bytes(folder / "free" / file), read_bytes(folder / "bounded" / file))
            << file;
}

TEST(Memory, ScansThatNeedMoreAreRefusedAtOnceWithWhatTheyNeed) {
    const TemporaryFolder folder;
    PointCloud cloud;
    constexpr int side = 3000;
    for (int i = 0; i < side * side; ++i) {
        cloud.positions.emplace_back(0.001F * static_cast<float>(i % side),
                                     0.001F * static_cast<float>(i / side), 0.0F);
    }
    write_point_cloud(folder / "large.ply", cloud);
    const std::string out = (folder / "out").string();
    // 9 million points of 12 + 30 bytes, and 256 MiB.
    const ProgramResult result =
        roomscribe({"run", (folder / "large.ply").string(), "-o", out, "--memory", "600M"});
    expect_error(result, 2, {"--memory 600M", "9.0 million points", "617M"});
    EXPECT_LT(result.peak_memory, std::size_t{300} << 20U);
    EXPECT_FALSE(std::filesystem::exists(out));
}

/// A file of `count` times the same bytes between others.
void write_repeated(const std::filesystem::path& path, std::string_view head,
                    const std::string& repeated, int count) {
    std::ofstream file(path, std::ios::binary);
    file << head;
    for (int i = 0; i < count; ++i)
        file << repeated;
}

std::string repeated(std::string_view text, std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i)
        all += text;
    return all;
}

TEST(Memory, WhatIsInAFileIsSaidWithoutKeepingIt) {
    constexpr std::size_t block = 100000;
    constexpr int num_blocks = 80;
    constexpr std::size_t num_points = block * num_blocks;
    // 96 MB of positions alone would not fit.
    constexpr std::size_t bound = std::size_t{64} << 20U;
    const TemporaryFolder folder;
    // Twelve bytes of which no float is NaN.
    const std::string binary = repeated("abc@abc@abc@", block);
    const auto write = [&](const char* name, const std::string& head, const std::string& points) {
        write_repeated(folder / name, head, points, num_blocks);
    };
    write("a.ply",
          fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\n",
                      num_points),
          binary);
    write("a.pcd",
          fmt::format("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH {0}\nHEIGHT 1\nPOINTS {0}\n"
                      "DATA binary\n",
                      num_points),
          binary);
    write("a.vtk",
          fmt::format("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS {} float\n",
                      num_points),
          binary);
    for (const char* order : {"False", "True"}) {
        std::string header = fmt::format(
            "{{'descr': '<f4', 'fortran_order': {}, 'shape': ({}, 3), }}", order, num_points);
        header.resize(117, ' ');
        write(order[0] == 'F' ? "a.npy" : "columns.npy",
              std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n", binary);
    }
    write("ascii.ply",
          fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\n",
                      num_points),
          repeated("1.5 2.5 3.5\n", block));
    write("a.xyz", "", repeated("1.5 2.5 3.5\n", block));
    write("a.3d", "", repeated("1.5 2.5 3.5\n", block));
    write("a.obj", "", repeated("v 1.5 2.5 3.5\n", block));
    write("a.ptx",
          fmt::format("{}\n{}\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                      "0 0 0 1\n",
                      num_blocks, block),
          repeated("1.5 2.5 3.5 0.5\n", block));
    // Not by this process: what a program takes is counted from what takes who starts it.
    for (const char* name : {"a.las", "a.e57"}) {
        const ProgramResult result =
            roomscribe({"convert", (folder / "a.ply").string(), (folder / name).string()});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        const ProgramResult result = roomscribe({"info", entry.path().string(), "--json"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(nlohmann::json::parse(result.out).at(0).at("points"), num_points);
        EXPECT_LT(result.peak_memory, bound) << entry.path();
    }
}

TEST(Memory, SizesAreUnderstoodOrRefused) {
    for (const char* size : {"8", "8X", "G", "100M", "-1G", "nanG"})
        expect_error(roomscribe({"run", "a.pcd", "-o", "out", "--memory", size}), 2, {size, "8G"});
}

}  // namespace
}  // namespace roomscribe::test
