// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;

/// The words under "Subcommands:" of the help.
std::vector<std::string> verbs_of_help() {
    std::istringstream help(roomscribe({"--help"}).out);
    std::vector<std::string> verbs;
    bool is_list = false;
    for (std::string line; std::getline(help, line);) {
        if (line == "Subcommands:") {
            is_list = true;
        } else if (is_list && line.size() > 2 && line.substr(0, 2) == "  " && line[2] != ' ') {
            verbs.push_back(line.substr(2, line.find(' ', 2) - 2));
        } else if (is_list && line.empty()) {
            break;
        }
    }
    return verbs;
}

/// What bash offers after these words; the last is being written.
std::string completed(const std::filesystem::path& script, const std::string& words, int last) {
    return run_program("/bin/bash", {"-c", "set -u; source " + script.string() + "; COMP_WORDS=(" +
                                               words + "); COMP_CWORD=" + std::to_string(last) +
                                               "; _roomscribe; echo \"${COMPREPLY[*]}\""})
        .out;
}

TEST(Completion, KnowsEveryVerb) {
    const std::vector<std::string> verbs = verbs_of_help();
    ASSERT_GT(verbs.size(), 15U);
    const std::string bash = roomscribe({"completion", "bash"}).out;
    const std::string zsh = roomscribe({"completion", "zsh"}).out;
    const std::string man = roomscribe({"man"}).out;
    for (const std::string& verb : verbs) {
        EXPECT_THAT(bash, HasSubstr("        " + verb + ")\n"));
        EXPECT_THAT(zsh, HasSubstr("        " + verb + ")\n"));
        EXPECT_THAT(man, HasSubstr("\n.SS " + verb + "\n"));
    }
    expect_error(roomscribe({"completion", "tcsh"}), 2, {"tcsh"});
}

TEST(Completion, CompletesInBash) {
    const TemporaryFolder folder;
    const auto script = folder / "completion.bash";
    std::ofstream(script) << roomscribe({"completion", "bash"}).out;
    EXPECT_EQ(completed(script, "roomscribe interp", 1), "interpret\n");
    EXPECT_EQ(completed(script, "roomscribe run --corr", 2), "--corrections\n");
    EXPECT_EQ(completed(script, "roomscribe run --progress j", 3), "json\n");
    const std::string file = (folder / "completion.bash").string();
    EXPECT_EQ(completed(script, "roomscribe run " + file.substr(0, file.size() - 4), 2),
              file + "\n");
}

TEST(ManualPage, HasOptionsAndExitCodesAndNoLineThatRoffMistakes) {
    std::istringstream man(roomscribe({"man"}).out);
    std::string all;
    for (std::string line; std::getline(man, line);) {
        all += line + "\n";
        if (line.empty() || line[0] != '.') continue;
        const std::string request = line.substr(0, line.find(' '));
        EXPECT_THAT(request, testing::AnyOf(".TH", ".SH", ".SS", ".TP", ".br"));
    }
    EXPECT_THAT(all, HasSubstr("\\-\\-corrections"));
    EXPECT_THAT(all, HasSubstr(".SH EXIT STATUS"));
    EXPECT_THAT(all, HasSubstr("130 interrupted"));
}

}  // namespace
}  // namespace roomscribe::test
