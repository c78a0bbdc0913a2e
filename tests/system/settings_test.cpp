// SPDX-License-Identifier: MIT
#include "roomscribe/core/settings.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/pipeline/pipeline_settings.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;

TEST(Settings, UnknownNameGetsTheNearestOne) {
    expect_error(roomscribe({"explain", "a.pcd", "--set", "sead=2"}), 2, {"sead", "seed"});
}

TEST(Settings, ValueThatDoesNotParseOrIsOutOfRangeIsRefused) {
    expect_error(roomscribe({"explain", "a.pcd", "--set", "seed=-1"}), 2, {"seed", "-1", "0"});
    expect_error(roomscribe({"explain", "a.pcd", "--seed", "many"}), 2, {"seed", "many"});
    expect_error(roomscribe({"explain", "a.pcd", "--set", "seed"}), 2, {"seed", "name=value"});
}

TEST(Settings, AreAllListedWithUnitRangeDefaultAndMeaning) {
    const std::string help = roomscribe({"run", "--help"}).out;
    const std::string markdown = roomscribe({"settings", "--markdown"}).out;
    for (const SettingEntry& entry : list_settings(PipelineSettings())) {
        for (const std::string& word :
             {entry.name, entry.range, entry.unit, entry.value, entry.doc}) {
            EXPECT_THAT(help, HasSubstr(word)) << entry.name;
        }
        EXPECT_THAT(markdown, HasSubstr("| `" + entry.name + "` | " + entry.value)) << entry.name;
    }
}

TEST(Settings, WrongSettingsFileIsRefusedWithItsLine) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "room.toml";
    const std::vector<std::string> explain{"explain", "a.pcd", "--config", file.string()};
    expect_error(roomscribe(explain), 3, {"room.toml"});
    std::ofstream(file) << "# fine\nseed = 3\n\nsead = 4\n";
    expect_error(roomscribe(explain), 2, {"room.toml, line 4", "sead", "seed"});
    std::ofstream(file) << "seed\n";
    expect_error(roomscribe(explain), 2, {"room.toml, line 1", "name = value"});
}

/// What run.json says of the settings after an interpretation with these arguments.
nlohmann::json resolved_settings(const TemporaryFolder& folder,
                                 const std::vector<std::string>& extra) {
    const std::string scan = write_room_scans(folder.path(), 1).front();
    std::vector<std::string> arguments{"interpret", scan, "-o", (folder / "out").string()};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    EXPECT_EQ(roomscribe(arguments).exit_code, 0);
    return read_json(folder / "out" / "run.json").at("settings");
}

TEST(Settings, FileOfDefaultsChangesNothing) {
    const TemporaryFolder folder;
    const nlohmann::json plain = resolved_settings(folder, {});
    const std::filesystem::path file = folder / "defaults.toml";
    std::ofstream(file) << roomscribe({"settings", "--toml"}).out;
    EXPECT_EQ(resolved_settings(folder, {"--config", file.string()}), plain);
}

TEST(Settings, CommandLineGoesOverTheFileAndRunJsonHoldsWhatWasSet) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "room.toml";
    std::ofstream(file) << "seed = 3\n";
    const nlohmann::json from_file = resolved_settings(folder, {"--config", file.string()});
    EXPECT_EQ(from_file.at("seed"), 3);
    const nlohmann::json from_set =
        resolved_settings(folder, {"--config", file.string(), "--set", "seed=4"});
    EXPECT_EQ(from_set.at("seed"), 4);
    const nlohmann::json from_seed = resolved_settings(folder, {"--set", "seed=4", "--seed", "5"});
    EXPECT_EQ(from_seed.at("seed"), 5);
}

}  // namespace
}  // namespace roomscribe::test
