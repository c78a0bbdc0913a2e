// SPDX-License-Identifier: MIT
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;

TEST(Reproduce, TableOneStandsBesideThePapers) {
    const TemporaryFolder folder;
    const std::vector<std::string> scans = write_room_scans(folder.path(), 2);
    std::vector<std::string> arguments{"reproduce", "table1", "--json"};
    for (const char* row : {"--cluttered", "--plane", "--outdoor"})
        arguments.insert(arguments.end(), {row, scans[0], scans[1]});
    const ProgramResult result = roomscribe(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    ASSERT_EQ(json.at("rows").size(), 3U);
    const auto& row = json["rows"][0];
    EXPECT_EQ(row.at("paper").at("t_fpfh"), 45.0);
    EXPECT_GT(row.at("ours").at("t_fpfh"), 0.0);
    EXPECT_GT(row.at("ours").at("s_fpfh"), 0.0);
    EXPECT_NEAR(row.at("points"), 1e4, 300.0);
    EXPECT_TRUE(row.at("s_true").is_null());
    EXPECT_THAT(row.at("scans"), HasSubstr("scan1"));
}

TEST(Reproduce, TableTwoStandsBesideThePapers) {
    const ProgramResult text = roomscribe({"reproduce", "table2", "--pairs", "1"});
    ASSERT_EQ(text.exit_code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("2.70 +- 2.96"));
    EXPECT_THAT(text.out, HasSubstr("ICP combined"));

    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const std::string poses = (folder / "poses.txt").string();
    std::ofstream(poses) << "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n";
    const ProgramResult own =
        roomscribe({"reproduce", "table2", "--scans", scan, scan, "--poses", poses, "--json"});
    ASSERT_EQ(own.exit_code, 0) << own.err;
    for (const auto& row : nlohmann::json::parse(own.out).at("rows")) {
        EXPECT_EQ(row.at("aligned"), 1);
        EXPECT_NEAR(row.at("ours").at("mean")[2], 0.0, 1e-3);  // a scan lies upon itself
    }
    expect_error(roomscribe({"reproduce", "table2", "--scans", scan, scan}), 2, {"--poses"});
}

TEST(Reproduce, TableFourStandsBesideThePapers) {
    const ProgramResult result = roomscribe({"reproduce", "table4", "--scenes", "1", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("1/1  office-2"));
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("scenes"), 1);
    ASSERT_EQ(json.at("rows").size(), 9U);
    const auto& wall = json["rows"][2];
    EXPECT_EQ(wall.at("label"), "wall");
    EXPECT_EQ(wall.at("paper").at("correct"), 50);
    for (const char* way : {"by_rules", "by_default"}) {
        EXPECT_EQ(wall.at(way).at("ground_truth"), 4) << way;
        EXPECT_GE(wall[way].at("correct"), 3) << way;
        EXPECT_EQ(wall[way].at("scenes"), 1) << way;
    }
    expect_error(roomscribe({"reproduce", "table4", "--scenes", "14"}), 2, {"--scenes"});
}

TEST(Reproduce, FigureOneIsAPicture) {
    const TemporaryFolder folder;
    const std::string path = (folder / "figure.svg").string();
    const ProgramResult result = roomscribe({"reproduce", "figure1", "-o", path});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("after filtering"));
    std::ifstream file(path);
    const std::string svg{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    EXPECT_THAT(svg, testing::StartsWith("<svg"));
    EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
}

TEST(Reproduce, SaysWhatItCanDo) {
    expect_error(roomscribe({"reproduce"}), 2, {"subcommand"});
    expect_error(roomscribe({"reproduce", "figure1"}), 2, {"--output"});
    expect_error(roomscribe({"reproduce", "table1", "--plane", "one.ply"}), 2, {"--plane"});
}

}  // namespace
}  // namespace roomscribe::test
