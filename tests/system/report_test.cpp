// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "system/program.hpp"

namespace roomscribe::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Cell {
    std::string text;  ///< without tags
    std::string sort;  ///< the value in full, where the page has it
    double number() const { return std::stod(sort); }
};
using Row = std::vector<Cell>;

std::string between(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + from.size();
    return text.substr(begin, text.find(to, begin) - begin);
}

/// Rows of the table in `html` whose caption begins with these words.
std::vector<Row> read_table(const std::string& html, const std::string& caption) {
    const std::string table = between(html, "<caption>" + caption, "</table>");
    std::vector<Row> rows;
    std::size_t at = table.find("<tbody>");
    while ((at = table.find("<tr", at)) != std::string::npos) {
        const std::size_t end = table.find("</tr>", at);
        const std::string line = table.substr(at, end - at);
        static const std::regex cell("<t[hd]([^>]*)>([^]*?)</t[hd]>");
        static const std::regex tag("<[^>]*>");
        Row row;
        for (std::sregex_iterator i(line.begin(), line.end(), cell), none; i != none; ++i) {
            row.push_back({std::regex_replace((*i)[2].str(), tag, ""),
                           between((*i)[1].str(), "data-sort=\"", "\"")});
        }
        rows.push_back(std::move(row));
        at = end;
    }
    return rows;
}

/// Coordinates in scene.json are rounded to 1e-6 m, shares to as much.
constexpr double rounding = 2e-6;

void expect_rooms(const std::string& html, const Json& scene) {
    const std::vector<Row> rows = read_table(html, "Heights are measured");
    const Json& rooms = scene.at("rooms");
    ASSERT_EQ(rows.size(), rooms.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][0].text, rooms[i].at("id"));
        EXPECT_NEAR(rows[i][1].number(), rooms[i].at("area").get<double>(), rounding);
        EXPECT_NEAR(rows[i][2].number(), rooms[i].at("volume").get<double>(), rounding);
        EXPECT_NEAR(rows[i][3].number(), rooms[i].at("floor_height").get<double>(), rounding);
        EXPECT_NEAR(rows[i][4].number(), rooms[i].at("ceiling_height").get<double>(), rounding);
    }
}

void expect_components(const std::string& html, const Json& scene) {
    std::map<std::string, Row> listed;
    for (const Row& row : read_table(html, "Coverage is the share")) {
        if (row[7].text.rfind("rejected", 0) != 0) listed[row[0].sort] = row;
    }
    ASSERT_EQ(listed.size(), scene.at("components").size());
    for (const Json& component : scene.at("components")) {
        SCOPED_TRACE(component.at("id"));
        const Row& row = listed.at(component.at("id"));
        const Json& evidence = component.at("evidence");
        EXPECT_EQ(std::stoull(row[4].sort), evidence.at("points").get<std::uint64_t>());
        if (evidence.contains("rms")) {
            EXPECT_NEAR(row[6].number() / 1e3, evidence.at("rms").get<double>(), rounding);
        }
        EXPECT_EQ(row[7].text.rfind(component.at("verdict").get<std::string>(), 0), 0U);
    }
}

TEST(Report, SaysWhatSceneAndRegistrationSay) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out";
    std::vector<std::string> arguments = write_room_scans(folder.path(), 3);
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"-o", out.string()});
    ASSERT_EQ(roomscribe(arguments).exit_code, 0);
    const std::string html = read_bytes(out / "report.html");
    expect_rooms(html, read_json(out / "scene.json"));
    expect_components(html, read_json(out / "scene.json"));

    const Json registration = read_json(out / "registration.json");
    const std::vector<Row> links = read_table(html, "Sigma is one standard deviation");
    ASSERT_EQ(links.size(), registration.at("links").size());
    ASSERT_FALSE(links.empty());
    for (std::size_t i = 0; i < links.size(); ++i) {
        const Json& link = registration.at("links")[i];
        EXPECT_EQ(std::stoull(links[i][0].sort), link.at("source").get<std::uint64_t>());
        EXPECT_EQ(std::stoull(links[i][1].sort), link.at("target").get<std::uint64_t>());
        EXPECT_EQ(links[i][2].text, link.at("verdict"));
        EXPECT_NEAR(links[i][3].number() / 100, link.at("probability").get<double>(), rounding);
        EXPECT_NEAR(links[i][5].number() / 100, link.at("overlap").get<double>(), rounding);
        EXPECT_NEAR(links[i][7].number() / 1e3, link.at("rmse").get<double>(), rounding);
        EXPECT_EQ(std::stoull(links[i][8].sort), link.at("inliers").get<std::uint64_t>());
    }
    const std::vector<Row> poses = read_table(html, "Each scan");
    ASSERT_EQ(poses.size(), registration.at("scans").size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Json& residual = registration.at("scans")[i].at("residual");
        if (residual.is_number()) {
            EXPECT_NEAR(poses[i][8].number() / 1e3, residual.get<double>(), rounding);
        }
    }
    const Json run = read_json(out / "run.json");
    const std::vector<Row> files = read_table(html, "xxh64sum gives");
    ASSERT_EQ(files.size(), run.at("inputs").size() + run.at("results").size());
    EXPECT_EQ(files.back()[0].text, "scene.json");
    EXPECT_EQ(files.back()[3].text, run.at("results").back().at("xxh64"));
}

TEST(Report, OfAFloorOfTwentyScansCanBeMailed) {
    const TemporaryFolder folder;
    const fs::path floor = folder / "floor";
    const fs::path out = folder / "out";
    ASSERT_EQ(
        roomscribe({"simulate", "floor", "--coarseness", "12", "-o", floor.string()}).exit_code, 0);
    std::vector<std::string> arguments{"interpret"};
    for (const auto& entry : fs::directory_iterator(floor / "scans"))
        arguments.push_back(entry.path().string());
    std::sort(arguments.begin() + 1, arguments.end());
    EXPECT_GE(arguments.size(), 21U);
    for (const std::string& more :
         {std::string("--poses"), (floor / "truth" / "poses.txt").string(), std::string("-o"),
          out.string()})
        arguments.push_back(more);
    ASSERT_EQ(roomscribe(arguments).exit_code, 0);
    const std::string html = read_bytes(out / "report.html");
    EXPECT_LT(html.size(), 60'000'000U);
    expect_rooms(html, read_json(out / "scene.json"));
    expect_components(html, read_json(out / "scene.json"));
    // run.json is written right before the report.
    const auto writing =
        fs::last_write_time(out / "report.html") - fs::last_write_time(out / "run.json");
    EXPECT_LT(std::chrono::duration<double>(writing).count(), 10.0);
}

}  // namespace
}  // namespace roomscribe::test
