// SPDX-License-Identifier: MIT
#include "roomscribe/core/edit_distance.hpp"

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

TEST(EditDistance, CountsLettersPutInTakenOutAndReplaced) {
    EXPECT_EQ(edit_distance("door-2", "door-2"), 0U);
    EXPECT_EQ(edit_distance("dor-2", "door-2"), 1U);
    EXPECT_EQ(edit_distance("door-2", "dor-2"), 1U);
    EXPECT_EQ(edit_distance("door-2", "door-3"), 1U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
    EXPECT_EQ(edit_distance("", "wall"), 4U);
    EXPECT_EQ(edit_distance("ab", "ba"), 2U);
}

}  // namespace
}  // namespace roomscribe
