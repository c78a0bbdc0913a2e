// SPDX-License-Identifier: MIT
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/simulated_rooms.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using Clock = std::chrono::steady_clock;
using Files = std::map<std::string, std::string>;

/// Without what begins with `first` and ends with `last`, both included.
void cut_out(std::string& text, std::string_view first, std::string_view last) {
    const std::size_t begin = text.find(first);
    ASSERT_NE(begin, std::string::npos) << first;
    const std::size_t end = text.find(last, begin);
    ASSERT_NE(end, std::string::npos) << last;
    text.erase(begin, end + last.size() - begin);
}

/// A file as it must be after any run: without times and memory.
std::string comparable(const std::filesystem::path& path) {
    std::string text = read_bytes(path);
    if (path.filename() == "run.json") cut_out(text, "\"stages\"", "]");
    if (path.filename() == "report.html") {
        cut_out(text, "Computing time", "</dd>");
        const std::size_t total = text.find(" s in all. Memory");
        EXPECT_NE(total, std::string::npos);
        text.erase(text.rfind('>', total), text.find("</table>", total) - text.rfind('>', total));
    }
    return text;
}

Files files_of(const std::filesystem::path& folder) {
    Files files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        files[std::filesystem::relative(entry.path(), folder).string()] = comparable(entry.path());
    }
    return files;
}

void expect_same_files(const Files& files, const Files& expected) {
    std::set<std::string> names;
    for (const auto& [name, text] : files)
        names.insert(name);
    for (const auto& [name, text] : expected) {
        EXPECT_EQ(names.erase(name), 1U) << name << " is missing";
        // Not EXPECT_EQ, which would print megabytes.
        EXPECT_TRUE(files.count(name) == 0 || files.at(name) == text) << name << " differs";
    }
    EXPECT_THAT(names, testing::IsEmpty());
}

/// Results that a killed run left: whole. Its temporary and stage files begin with a dot.
void expect_whole(const std::filesystem::path& out, const Files& expected) {
    if (!std::filesystem::exists(out)) return;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out)) {
        const std::string name = std::filesystem::relative(entry.path(), out).string();
        const bool is_hidden =
            name.front() == '.' || entry.path().filename().string().front() == '.';
        if (is_hidden || !entry.is_regular_file()) continue;
        ASSERT_EQ(expected.count(name), 1U) << name;
        EXPECT_TRUE(comparable(entry.path()) == expected.at(name)) << name << " is not whole";
    }
}

class Resume : public testing::Test {
  protected:
    /// Two scans that belong together and one of another room, which so has a map apart: some
    /// hundred milliseconds of work.
    void SetUp() override {
        std::vector<Scan> scans = scan_furnished_room(1, 16.0);
        const Transform in_room(Eigen::Translation3d(2.0, 1.5, 1.4));
        scans.at(2).cloud = simulate_scan(other_room(), in_room, 1, 16.0).cloud;
        for (const Scan& scan : scans) {
            const auto path = folder_ / scan.name;
            write_point_cloud(path, scan.cloud);
            arguments_.push_back(path.string());
        }
        arguments_.insert(arguments_.begin(), "run");
    }

    std::vector<std::string> command(const std::filesystem::path& out,
                                     const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = arguments_;
        all.insert(all.end(), {"-o", out.string()});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    TemporaryFolder folder_;
    std::vector<std::string> arguments_;
};

TEST_F(Resume, AfterAKillAtAnyMomentTheResultIsTheSame) {
    const Clock::time_point start = Clock::now();
    ASSERT_EQ(roomscribe(command(folder_ / "whole")).exit_code, 0);
    const auto whole_time =
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start);
    const Files expected = files_of(folder_ / "whole");
    ASSERT_EQ(expected.count("labels.ply"), 1U);
    ASSERT_EQ(expected.count("set-2/labels.ply"), 1U);

    Random random(50);
    int num_killed = 0;
    int num_used = 0;
    for (int i = 0; i < 50; ++i) {
        const std::filesystem::path out = folder_ / fmt::format("out-{}", i);
        const auto moment = std::chrono::microseconds(
            static_cast<long>(random.uniform() * 1.02 * static_cast<double>(whole_time.count())));
        SCOPED_TRACE(fmt::format("killed after {} of {} us", moment.count(), whole_time.count()));
        const ProgramResult killed = roomscribe(command(out), {.kill_after = moment});
        if (killed.exit_code == 128 + SIGKILL) ++num_killed;
        expect_whole(out, expected);

        const ProgramResult resumed = roomscribe(command(out, {"--resume", "--progress", "json"}));
        ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
        if (resumed.err.find("results of the run before are used") != std::string::npos) ++num_used;
        EXPECT_EQ(resumed.err.find("damaged"), std::string::npos) << resumed.err;
        expect_same_files(files_of(out), expected);
        std::filesystem::remove_all(out);
    }
    // The moments are of a run whose speed is not known beforehand: most must have hit it.
    EXPECT_GE(num_killed, 25);
    EXPECT_GE(num_used, 5);
}

TEST_F(Resume, ResultsOfAnotherJobAreNotUsedAndThatIsSaid) {
    const std::filesystem::path out = folder_ / "out";
    std::filesystem::create_directories(out / ".stages");
    std::ofstream(out / ".stages" / "registration") << "rs-stage, but of another job";
    const ProgramResult result = roomscribe(command(out, {"--resume", "--progress", "json"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr("nothing to go on from"));
    EXPECT_THAT(result.err, testing::HasSubstr("computed again"));
    EXPECT_FALSE(std::filesystem::exists(out / ".stages"));
}

}  // namespace
}  // namespace roomscribe::test
