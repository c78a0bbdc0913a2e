// SPDX-License-Identifier: MIT
#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

constexpr std::array scan_names{"000.ply", "001.ply", "002.ply", "003.ply"};

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
    for (const char* name : scan_names)
        num_input_points += read_scan(out / "office" / "scans" / name).cloud.size();
    EXPECT_EQ(map.size(), num_input_points);
    EXPECT_EQ(labels.size(), map.size());

    const nlohmann::json scene = read_json(out / "scene.json");
    EXPECT_EQ(scene.at("format"), "roomscribe-scene");
    EXPECT_EQ(count_components(scene, "floor"), 1U);
    EXPECT_EQ(count_components(scene, "ceiling"), 1U);
    EXPECT_GE(count_components(scene, "wall"), 4U);
}

TEST(Demo, ShowsTheScoreBesideTheResult) {
    const TemporaryFolder folder;
    const std::filesystem::path out = folder / "out";
    const ProgramResult result =
        roomscribe({"demo", "-o", out.string(), "--json", "--progress", "none"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("scans").size(), 4U);
    for (const auto& scan : json.at("scans"))
        EXPECT_TRUE(scan.at("placed")) << scan;
    const auto& score = json.at("score");
    EXPECT_EQ(score.at("detection").at("floor").at("correct"), 1);
    EXPECT_EQ(score.at("detection").at("ceiling").at("correct"), 1);
    EXPECT_EQ(score.at("detection").at("wall").at("correct"), 4);
    EXPECT_GE(score.at("points").at("floor").at("iou"), 0.95);
    EXPECT_LT(score.at("axes").at("up").at("max"), 0.3);
    EXPECT_EQ(score.at("recall").at("0.1 m, 1 deg").at("recall"), 1.0);
    EXPECT_THAT(read_bytes(out / "report.html"), testing::HasSubstr("Score against truth"));

    // The referee, asked about the files, says the same.
    const ProgramResult referee =
        roomscribe({"evaluate", (out / "office").string(), out.string(), "--json"});
    ASSERT_EQ(referee.exit_code, 0) << referee.err;
    const auto again = nlohmann::json::parse(referee.out);
    EXPECT_EQ(again.at("detection"), score.at("detection"));
    EXPECT_EQ(again.at("links"), score.at("links"));
}

TEST(Demo, GivesTheSameBitsForAnyNumberOfThreadsAndEveryTime) {
    const TemporaryFolder folder;
    const std::filesystem::path first = folder / "demo";
    ASSERT_EQ(roomscribe({"demo", "-o", first.string(), "--threads", "1"}).exit_code, 0);
    std::vector<std::string> run{"run"};
    for (const char* name : scan_names)
        run.push_back((first / "office" / "scans" / name).string());
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
