// SPDX-License-Identifier: MIT
#include "cli/scorecard.hpp"

#include <ctime>
#include <fstream>
#include <iterator>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "roomscribe/io/atomic_file.hpp"

namespace roomscribe::cli {
namespace {

constexpr std::string_view preamble =
    "# Scorecard\n\n"
    "What the program reaches on simulated scenes (docs/simulation.md), scored as "
    "docs/evaluation.md\n"
    "says. Written by `./dev evaluate SUITE`; each part is the last run of its suite.\n\n";

std::string read_if_there(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::string(preamble);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The first line, with its end.
std::string_view first_line(std::string_view text) {
    return text.substr(0, text.find('\n') + 1);
}

}  // namespace

void update_scorecard(const std::filesystem::path& path, std::string_view part) {
    std::string text = read_if_there(path);
    const std::size_t begin = text.find(first_line(part));
    if (begin == std::string::npos) {
        text += part;
    } else {
        const std::size_t next = text.find("\n## ", begin);
        const std::size_t end = next == std::string::npos ? text.size() : next + 1;
        text.replace(begin, end - begin, part);
    }
    write_file(path, "scorecard", text);
}

std::string describe_machine() {
    std::string processor = "unknown processor";
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);) {
        if (line.rfind("model name", 0) != 0) continue;
        processor = line.substr(line.find(':') + 2);
        break;
    }
    return fmt::format("{:%Y-%m-%d}, {}, {} threads", fmt::gmtime(std::time(nullptr)), processor,
                       std::thread::hardware_concurrency());
}

}  // namespace roomscribe::cli
