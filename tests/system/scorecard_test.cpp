// SPDX-License-Identifier: MIT
#include "cli/scorecard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using cli::update_scorecard;
using testing::EndsWith;
using testing::StartsWith;

TEST(Scorecard, IsBegunWhereThereIsNone) {
    const TemporaryFolder folder;
    update_scorecard(folder / "card.md", "## quick\n\nbad\n");
    const std::string text = read_bytes(folder / "card.md");
    EXPECT_THAT(text, StartsWith("# Scorecard\n"));
    EXPECT_THAT(text, EndsWith("\n\n## quick\n\nbad\n"));
}

TEST(Scorecard, KeepsThePartsOfOtherSuites) {
    const TemporaryFolder folder;
    const std::filesystem::path card = folder / "card.md";
    update_scorecard(card, "## quick\n\nold\n\n### points\n\nfew\n\n");
    update_scorecard(card, "## paper\n\nits own\n\n");
    update_scorecard(card, "## quick\n\nnew\n\n");
    EXPECT_THAT(read_bytes(card), EndsWith("\n\n## quick\n\nnew\n\n## paper\n\nits own\n\n"));
    update_scorecard(card, "## paper\n\nnewer\n\n");
    EXPECT_THAT(read_bytes(card), EndsWith("\n\n## quick\n\nnew\n\n## paper\n\nnewer\n\n"));
}

TEST(Scorecard, NamesAFileThatItCannotWrite) {
    const TemporaryFolder folder;
    EXPECT_THROW(update_scorecard(folder / "missing" / "card.md", "## quick\n"), IoError);
}

}  // namespace
}  // namespace roomscribe::test
