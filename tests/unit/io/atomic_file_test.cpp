// SPDX-License-Identifier: MIT
#include "roomscribe/io/atomic_file.hpp"

#include <algorithm>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

std::size_t count_files(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
    const test::TemporaryFolder folder;
    const auto path = folder / "a.txt";
    test::write_bytes(path, "old");
    AtomicFile file(path, "text");
    file.write("new ");
    file.write(std::string(3U << 20U, 'x'));
    EXPECT_EQ(test::read_bytes(path), "old");
    file.write(" end");
    file.commit();
    EXPECT_EQ(test::read_bytes(path), "new " + std::string(3U << 20U, 'x') + " end");
    EXPECT_EQ(count_files(folder.path()), 1U);
}

TEST(AtomicFile, LeavesNothingBehindAfterAnException) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.txt", "old");
    const auto interrupted = [&] {
        AtomicFile file(folder / "a.txt", "text");
        file.write(std::string(5U << 20U, 'x'));
        throw std::runtime_error("interrupted");
    };
    EXPECT_THROW(interrupted(), std::runtime_error);
    EXPECT_EQ(test::read_bytes(folder / "a.txt"), "old");
    EXPECT_EQ(count_files(folder.path()), 1U);
}

TEST(AtomicFile, FilesOfKilledProcessesAreRemovedAndNoOthers) {
    const test::TemporaryFolder folder;
    const pid_t gone = fork();
    if (gone == 0) {
        AtomicFile file(folder / "a.txt", "text");
        file.write(std::string(5U << 20U, 'x'));
        raise(SIGKILL);
    }
    waitpid(gone, nullptr, 0);
    test::write_bytes(folder / ".roomscribe-1x-0.tmp", "no such name");
    AtomicFile alive(folder / "b.txt", "text");
    EXPECT_EQ(count_files(folder.path()), 3U);
    remove_abandoned_files(folder.path());
    EXPECT_EQ(count_files(folder.path()), 2U);
    alive.commit();
    EXPECT_TRUE(std::filesystem::exists(folder / "b.txt"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
}

TEST(AtomicFile, SaysWhyItCannotBeCreated) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(AtomicFile(folder / "no" / "a.txt", "text"), IoError);
    EXPECT_THROW(AtomicFile(folder.path(), "text"), IoError);
    EXPECT_THROW(AtomicFile("/dev/null", "text"), IoError);
    try {
        AtomicFile file(folder / "no" / "a.txt", "text");
    } catch (const IoError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("No such file or directory"));
    }
    EXPECT_EQ(count_files(folder.path()), 0U);
}

/// A limit on the size of files stands in for a full disk: write() fails in the same way.
TEST(AtomicFile, FullDiskIsAnIoErrorAndLeavesNothingBehind) {
    const test::TemporaryFolder folder;
    rlimit old{};
    ::getrlimit(RLIMIT_FSIZE, &old);
    const rlimit small{1U << 20U, old.rlim_max};
    const auto old_handler = ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(write_file(folder / "a.txt", "text", std::string(4U << 20U, 'x')), IoError);
    ::setrlimit(RLIMIT_FSIZE, &old);
    ::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(count_files(folder.path()), 0U);
}

TEST(AtomicFile, FollowsALinkAndKeepsIt) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "real.txt", "old");
    std::filesystem::create_symlink(folder / "real.txt", folder / "link.txt");
    write_file(folder / "link.txt", "text", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
    EXPECT_EQ(test::read_bytes(folder / "real.txt"), "new");
}

TEST(AtomicFile, WritesIntoThePresentFolder) {
    const test::TemporaryFolder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    write_file("a.txt", "text", "content");
    std::filesystem::current_path(before);
    EXPECT_EQ(test::read_bytes(folder / "a.txt"), "content");
}

}  // namespace
}  // namespace roomscribe
