// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/stage_folder.hpp"

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_program.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

class StageFolderTest : public testing::Test {
  protected:
    StageFolder open(std::uint64_t job, RunStart start) {
        messages_.clear();
        return {folder_.path(), job, start,
                [this](std::string_view message) { messages_.emplace_back(message); }};
    }
    static void keep(StageFolder& stages, std::string_view name, std::string_view text) {
        stages.keep(name, [text](const ResultStore::Write& write) {
            write(std::as_bytes(std::span(text.data(), text.size() / 2)));
            write(std::as_bytes(
                std::span(text.data() + text.size() / 2, text.size() - text.size() / 2)));
        });
    }
    static std::string recall(StageFolder& stages, std::string_view name) {
        std::string text = "nothing";
        stages.recall(name, [&text](std::span<const std::byte> bytes) {
            text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        });
        return text;
    }

    test::TemporaryFolder folder_;
    std::vector<std::string> messages_;
};

TEST_F(StageFolderTest, HandsBackWhatIsOfTheSameJob) {
    StageFolder first = open(1, RunStart::afresh);
    EXPECT_FALSE(std::filesystem::exists(folder_ / ".stages"));
    keep(first, "pair-1-0", "some result");
    keep(first, "empty", "");
    StageFolder second = open(1, RunStart::resumed);
    EXPECT_THAT(messages_, testing::ElementsAre(testing::HasSubstr("2 results")));
    EXPECT_EQ(recall(second, "pair-1-0"), "some result");
    EXPECT_EQ(recall(second, "empty"), "");
    EXPECT_EQ(recall(second, "pair-2-0"), "nothing");
    second.remove();
    EXPECT_FALSE(std::filesystem::exists(folder_ / ".stages"));
    open(1, RunStart::resumed);
    EXPECT_THAT(messages_, testing::ElementsAre(testing::HasSubstr("nothing")));
}

TEST_F(StageFolderTest, ForgetsWhatIsOfAnotherJobOrWasNotToBeResumed) {
    StageFolder first = open(1, RunStart::afresh);
    keep(first, "pair-1-0", "some result");
    StageFolder other = open(2, RunStart::resumed);
    EXPECT_THAT(messages_, testing::ElementsAre(testing::HasSubstr("nothing"),
                                                testing::HasSubstr("computed again")));
    EXPECT_EQ(recall(other, "pair-1-0"), "nothing");
    keep(other, "pair-1-0", "another result");
    StageFolder afresh = open(2, RunStart::afresh);
    EXPECT_EQ(recall(afresh, "pair-1-0"), "nothing");
}

TEST_F(StageFolderTest, IgnoresDamage) {
    StageFolder first = open(1, RunStart::afresh);
    keep(first, "pair-1-0", "some result");
    const auto path = folder_ / ".stages" / "pair-1-0";
    const std::string whole = test::read_bytes(path);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 4);
        write_bytes(path, damaged);
        ASSERT_EQ(recall(first, "pair-1-0"), "nothing") << i;
        write_bytes(path, whole.substr(0, i));
        ASSERT_EQ(recall(first, "pair-1-0"), "nothing") << i;
    }
    StageFolder second = open(1, RunStart::resumed);
    EXPECT_THAT(messages_, testing::Contains(testing::HasSubstr("1 results are damaged")));
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(StageFolderTest, IsNoErrorWhereNothingCanBeKept) {
    write_bytes(folder_ / ".stages", "a file that is in the way");
    StageFolder stages(folder_ / ".stages", 1, RunStart::afresh,
                       [this](std::string_view message) { messages_.emplace_back(message); });
    keep(stages, "pair-1-0", "some result");
    EXPECT_THAT(messages_, testing::ElementsAre(testing::HasSubstr("cannot be kept")));
    EXPECT_EQ(recall(stages, "pair-1-0"), "nothing");
}

TEST(HashOfJob, TellsJobsApart) {
    RunRecord record;
    record.version = "1.0";
    record.command = "run";
    record.settings.emplace_back().name = "seed";
    record.settings.back().value = "1";
    record.inputs = {{"a/scan.ply", 100, 7}};
    const std::uint64_t hash = hash_of_job(record, "auto");
    RunRecord moved = record;
    moved.inputs[0].path = "b/scan.ply";
    moved.num_threads = 5;
    EXPECT_EQ(hash_of_job(moved, "auto"), hash);
    EXPECT_NE(hash_of_job(record, "mm"), hash);
    RunRecord other = record;
    other.settings[0].value = "2";
    EXPECT_NE(hash_of_job(other, "auto"), hash);
    other = record;
    other.inputs[0].xxh64 = 8;
    EXPECT_NE(hash_of_job(other, "auto"), hash);
    other = record;
    other.version = "1.1";
    EXPECT_NE(hash_of_job(other, "auto"), hash);
}

}  // namespace
}  // namespace roomscribe
