// SPDX-License-Identifier: MIT
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

TEST(Memory, SizesAreUnderstoodOrRefused) {
    for (const char* size : {"8", "8X", "G", "100M", "-1G", "nanG"})
        expect_error(roomscribe({"run", "a.pcd", "-o", "out", "--memory", size}), 2, {size, "8G"});
}

}  // namespace
}  // namespace roomscribe::test
