// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

TEST(Demo, LeavesEveryFileOfARun) {
    const TemporaryFolder folder;
    const std::filesystem::path out = folder / "out";
    const ProgramResult result = roomscribe({"demo", "-o", out.string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, testing::HasSubstr((out / "report.html").string()));
    for (const char* name : {"poses.txt", "registration.json", "map.ply", "labels.ply",
                             "scene.json", "report.html", "run.json"}) {
        EXPECT_GT(read_bytes(out / name).size(), 0U) << name;
    }

    const PointCloud map = read_scan(out / "map.ply").cloud;
    const PointCloud labels = read_scan(out / "labels.ply").cloud;
    std::size_t num_input_points = 0;
    for (const char* name : {"scan1.ply", "scan2.ply", "scan3.ply"}) {
        num_input_points += read_scan(out / "scans" / name).cloud.size();
    }
    EXPECT_EQ(map.size(), num_input_points);
    EXPECT_EQ(labels.size(), map.size());

    const nlohmann::json scene = read_json(out / "scene.json");
    EXPECT_EQ(scene.at("format"), "roomscribe-scene");
    EXPECT_EQ(count_components(scene, "floor"), 1U);
    EXPECT_EQ(count_components(scene, "ceiling"), 1U);
    EXPECT_GE(count_components(scene, "wall"), 4U);
}

TEST(Demo, JsonSaysThatAllScansArePlacedAndHowLargeTheRoomIs) {
    const TemporaryFolder folder;
    const ProgramResult result =
        roomscribe({"demo", "-o", (folder / "out").string(), "--json", "--progress", "none"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("scans").size(), 3U);
    for (const auto& scan : json.at("scans"))
        EXPECT_TRUE(scan.at("placed")) << scan;
    // The room is 5.6 x 4.2 x 2.6 m; a horizontal axis may come out as x or as y.
    std::vector<double> size = json.at("size");
    ASSERT_EQ(size.size(), 3U);
    std::sort(size.begin(), size.begin() + 2);
    EXPECT_NEAR(size[0], 4.2, 0.1);
    EXPECT_NEAR(size[1], 5.6, 0.1);
    EXPECT_NEAR(size[2], 2.6, 0.05);
    EXPECT_GT(json.at("labels").at("floor").at("points"), 0);
}

TEST(Demo, GivesTheSameBitsForAnyNumberOfThreadsAndEveryTime) {
    const TemporaryFolder folder;
    const std::filesystem::path first = folder / "demo";
    ASSERT_EQ(roomscribe({"demo", "-o", first.string(), "--threads", "1"}).exit_code, 0);
    std::vector<std::string> run{"run"};
    for (const char* name : {"scan1.ply", "scan2.ply", "scan3.ply"}) {
        run.push_back((first / "scans" / name).string());
    }
    for (const char* threads : {"1", "2"}) {
        const std::filesystem::path again = folder / (std::string("threads") + threads);
        std::vector<std::string> arguments = run;
        arguments.insert(arguments.end(), {"-o", again.string(), "--threads", threads});
        ASSERT_EQ(roomscribe(arguments).exit_code, 0);
        for (const char* name :
             {"poses.txt", "registration.json", "map.ply", "labels.ply", "scene.json"}) {
            EXPECT_TRUE(read_bytes(first / name) == read_bytes(again / name))
                << name << " differs with " << threads << " threads";
        }
    }
}

}  // namespace
}  // namespace roomscribe::test
