// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "system/program.hpp"

namespace roomscribe::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> small_room{"simulate", "room", "--scans", "1", "--coarseness", "8"};

ProgramResult simulate(const fs::path& folder, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = small_room;
    arguments.insert(arguments.end(), {"-o", folder.string()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return roomscribe(arguments);
}

TEST(Simulate, TheSameSeedGivesTheSameFiles) {
    const TemporaryFolder folder;
    ASSERT_EQ(simulate(folder / "a", {"--seed", "5", "--threads", "1"}).exit_code, 0);
    ASSERT_EQ(simulate(folder / "b", {"--seed", "5", "--threads", "2"}).exit_code, 0);
    ASSERT_EQ(simulate(folder / "c", {"--seed", "6"}).exit_code, 0);
    for (const char* name : {"map.ply", "scenario.json", "truth/poses.txt", "truth/scene.json",
                             "truth/map.labels.npy", "truth/map.instances.npy"}) {
        EXPECT_GT(read_bytes(folder / "a" / name).size(), 0U) << name;
        EXPECT_TRUE(read_bytes(folder / "a" / name) == read_bytes(folder / "b" / name)) << name;
        EXPECT_FALSE(read_bytes(folder / "a" / name) == read_bytes(folder / "c" / name)) << name;
    }
}

TEST(Simulate, APlanCanBeEditedAndSimulated) {
    const TemporaryFolder folder;
    ASSERT_EQ(simulate(folder / "a").exit_code, 0);
    ASSERT_EQ(simulate(folder / "plan", {"--plan"}).exit_code, 0);
    EXPECT_FALSE(fs::exists(folder / "plan" / "map.ply"));
    const std::string plan = (folder / "plan" / "scenario.json").string();
    const ProgramResult again = roomscribe({"simulate", plan, "-o", (folder / "b").string()});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_bytes(folder / "a" / "scenario.json"),
              read_bytes(folder / "b" / "scenario.json"));

    expect_error(roomscribe({"simulate", plan, "-o", (folder / "b").string(), "--seed", "3"}), 2,
                 {"scenario.json", "seed"});
}

TEST(Simulate, SaysWhatIsWrongWithAScenario) {
    const TemporaryFolder folder;
    const fs::path path = folder / "mine.json";
    const auto complaint = [&](const std::string& text, int exit_code,
                               const std::vector<std::string>& words) {
        std::ofstream(path) << text;
        expect_error(roomscribe({"simulate", path.string(), "-o", (folder / "out").string()}),
                     exit_code, words);
        EXPECT_FALSE(fs::exists(folder / "out"));
    };
    const std::string room =
        R"("rooms": [{"name": "a", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]]}])";
    complaint("{" + room + R"(, "dors": []})", 3, {"mine.json", "dors"});
    complaint("{" + room + "}", 2, {"stations"});
    complaint("{" + room + R"(, "stations": [{"at": [9, 1, 1]}]})", 2,
              {"station", "inside a room"});
    complaint("{" + room + R"(, "stations": [{"at": [1, 1, 1]}],
                 "openings": [{"room": "a", "at": [2, 0], "height": 5}]})",
              2, {"opening", "wholly within"});
    complaint("{" + room + R"(, "stations": [{"at": [1, 1, 1]}], "items": [{"kind": "tabel"}]})", 2,
              {"tabel"});
    expect_error(roomscribe({"simulate", "castle", "-o", (folder / "out").string()}), 2,
                 {"castle", "office"});
}

}  // namespace
}  // namespace roomscribe::test
