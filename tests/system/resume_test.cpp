// SPDX-License-Identifier: MIT
#include <algorithm>
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

/// Runs the job, stops it at moments that the seed draws, each time goes on with --resume, and
/// compares the result with that of a run that nobody stopped.
class Resume : public testing::Test {
  protected:
    void write_scans(const std::vector<Scan>& scans) {
        arguments_ = {"run"};
        for (const Scan& scan : scans) {
            arguments_.push_back((folder_ / scan.name).string());
            write_point_cloud(arguments_.back(), scan.cloud);
        }
    }

    std::vector<std::string> command(const std::filesystem::path& out,
                                     const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = arguments_;
        all.insert(all.end(), {"-o", out.string()});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    void run_whole() {
        const Clock::time_point start = Clock::now();
        ASSERT_EQ(roomscribe(command(folder_ / "whole")).exit_code, 0);
        whole_time_ = Clock::now() - start;
        expected_ = files_of(folder_ / "whole");
    }

    void kill_and_resume(const ProgramOptions& how) {
        std::filesystem::remove_all(out_);
        const Clock::time_point start = Clock::now();
        const ProgramResult killed = roomscribe(command(out_), how);
        if (killed.exit_code == 128 + SIGKILL) {
            ++num_killed_;
        } else {
            // The machine is quicker now: later moments should hit.
            whole_time_ = std::min<Clock::duration>(whole_time_, Clock::now() - start);
        }
        expect_whole(out_, expected_);
        const ProgramResult resumed = roomscribe(command(out_, {"--resume", "--progress", "json"}));
        ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
        if (resumed.err.find("results of the run before are used") != std::string::npos)
            ++num_used_;
        EXPECT_EQ(resumed.err.find("damaged"), std::string::npos) << resumed.err;
        expect_same_files(files_of(out_), expected_);
    }

    TemporaryFolder folder_;
    std::filesystem::path out_ = folder_ / "out";
    std::vector<std::string> arguments_;
    Clock::duration whole_time_{};
    Files expected_;
    int num_killed_ = 0;
    int num_used_ = 0;
};

/// Fifty moments in five parts, which may run side by side.
class ResumeAtRandom : public Resume, public testing::WithParamInterface<std::uint64_t> {};

TEST_P(ResumeAtRandom, TheResultIsThatOfARunThatNobodyStopped) {
    std::vector<Scan> scans = scan_furnished_room(1, 20.0);
    scans.pop_back();
    write_scans(scans);
    run_whole();
    ASSERT_EQ(expected_.count("labels.ply"), 1U);
    constexpr int num_moments = 10;
    Random random(GetParam());
    for (int i = 0; i < num_moments; ++i) {
        const auto moment =
            std::chrono::duration_cast<Clock::duration>(random.uniform() * whole_time_);
        SCOPED_TRACE(
            fmt::format("killed after {:.6f} s", std::chrono::duration<double>(moment).count()));
        kill_and_resume({.kill_after = moment});
    }
    // How fast the runs are is not known beforehand.
    EXPECT_GE(num_killed_, 1);
}

INSTANTIATE_TEST_SUITE_P(Moments, ResumeAtRandom, testing::Range<std::uint64_t>(0, 5));

TEST_F(Resume, GoesOnWithMapsApart) {
    std::vector<Scan> scans = scan_furnished_room(1, 20.0);
    const Transform in_room(Eigen::Translation3d(2.0, 1.5, 1.4));
    scans.at(2).cloud = simulate_scan(other_room(), in_room, 1, 20.0).cloud;
    write_scans(scans);
    run_whole();
    ASSERT_EQ(expected_.count("set-2/labels.ply"), 1U);
    for (const char* file : {".stages/registration", ".stages/interpretation", "set-2/map.ply"}) {
        SCOPED_TRACE(file);
        kill_and_resume({.kill_at_file = out_ / file});
    }
    EXPECT_EQ(num_killed_, 3);
    EXPECT_EQ(num_used_, 3);
}

TEST_F(Resume, ResultsOfAnotherJobAreNotUsedAndThatIsSaid) {
    write_scans(scan_furnished_room(1, 20.0));
    std::filesystem::create_directories(out_ / ".stages");
    std::ofstream(out_ / ".stages" / "registration") << "rs-stage, but of another job";
    const ProgramResult result = roomscribe(command(out_, {"--resume", "--progress", "json"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr("nothing to go on from"));
    EXPECT_THAT(result.err, testing::HasSubstr("computed again"));
    EXPECT_FALSE(std::filesystem::exists(out_ / ".stages"));
}

}  // namespace
}  // namespace roomscribe::test
