// SPDX-License-Identifier: MIT
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(CommandLine, PrintsShortHelpWithoutArguments) {
    const ProgramResult result = roomscribe({});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    for (const char* verb : {"run", "register", "interpret", "convert", "info", "explain", "export",
                             "demo", "settings", "version", "view", "completion", "man"}) {
        EXPECT_THAT(result.out, HasSubstr(verb));
    }
    EXPECT_LT(std::count(result.out.begin(), result.out.end(), '\n'), 40);
}

TEST(CommandLine, TellsItsVersion) {
    const std::string version = "roomscribe " ROOMSCRIBE_VERSION "\n";
    EXPECT_EQ(roomscribe({"--version"}).out, version);
    EXPECT_THAT(roomscribe({"version"}).out, StartsWith(version + "3D view of reports: "));
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
    expect_error(roomscribe({"rnu"}), 2, {"rnu"});
    expect_error(roomscribe({"run", "a.pcd", "-o", "out", "--colour"}), 2, {"--colour"});
    expect_error(roomscribe({"run", "-o", "out"}), 2, {"SCANS"});
    expect_error(roomscribe({"run", "a.pcd"}), 2, {"--output"});
    expect_error(roomscribe({"run", "a.pcd", "-o", "out", "--threads", "-1"}), 2, {"--threads"});
    expect_error(roomscribe({"run", "a.pcd", "-o", "out", "--progress", "loud"}), 2,
                 {"--progress", "loud"});
    expect_error(roomscribe({"convert", "a.pcd", "b.pcd", "--encoding", "zip"}), 2,
                 {"--encoding", "zip", "binary_compressed"});
    expect_error(roomscribe({"interpret", "a.pcd", "b.pcd", "-o", "out"}), 2, {"--poses"});
}

TEST(CommandLine, RefusesAnOutputThatIsAFile) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    expect_error(roomscribe({"interpret", scan, "-o", scan}), 3, {"scan1.ply"});
}

TEST(CommandLine, LeavesNoFileWhenInterrupted) {
    const TemporaryFolder folder;
    std::vector<std::string> arguments{"run"};
    for (const std::string& scan : write_room_scans(folder.path(), 3))
        arguments.push_back(scan);
    const std::filesystem::path out = folder / "deep" / "out";
    arguments.insert(arguments.end(), {"-o", out.string(), "--progress", "json"});

    const ProgramResult result = roomscribe(arguments, {.interrupt_at_first_message = true});
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, testing::EndsWith("\nroomscribe: interrupted\n"));
    EXPECT_FALSE(std::filesystem::exists(folder / "deep"));
}

TEST(CommandLine, ReportsProgressAsJsonLines) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const ProgramResult result = roomscribe(
        {"interpret", scan, "-o", (folder / "out").string(), "--progress", "json", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(nlohmann::json::accept(result.out)) << result.out;

    std::istringstream lines(result.err);
    int num_stages = 0;
    for (std::string line; std::getline(lines, line);) {
        const auto json = nlohmann::json::parse(line, nullptr, false);
        ASSERT_TRUE(json.is_object()) << line;
        if (!json.contains("stage")) continue;
        ++num_stages;
        EXPECT_GE(json.at("fraction").get<double>(), 0.0);
        EXPECT_LE(json.at("fraction").get<double>(), 1.0);
    }
    EXPECT_GT(num_stages, 0);
}

TEST(CommandLine, ShowsStageRateAndTimeLeftOnATerminal) {
    const std::filesystem::path script = "/usr/bin/script";
    if (!std::filesystem::exists(script)) GTEST_SKIP() << "script(1) is not installed";
    const TemporaryFolder folder;
    // One thread: a rate is shown of stages that last for a second or so.
    std::string command = ROOMSCRIBE_PROGRAM " run --threads 1 -o " + (folder / "out").string();
    for (const std::string& scan : write_room_scans(folder.path(), 3))
        command += " " + scan;
    const ProgramResult result = run_program(script, {"-qec", command, "/dev/null"});
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_THAT(result.out, testing::ContainsRegex("\\[#+\\.+\\] register [0-9]+ %"));
    EXPECT_THAT(result.out, testing::ContainsRegex("[0-9.]+ %/s, [0-9]+ s left"));
    // The bar is gone at the end, the table of results stays.
    EXPECT_THAT(result.out, testing::ContainsRegex("\r.\\[Kscan +points +placed"));
}

TEST(CommandLine, IsQuietOnStderrWhenItIsNoTerminal) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const ProgramResult result = roomscribe({"explain", scan});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("spacing"));
}

}  // namespace
}  // namespace roomscribe::test
