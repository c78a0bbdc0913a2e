// SPDX-License-Identifier: MIT
#include "roomscribe/core/disjoint_sets.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"

namespace roomscribe {
namespace {

TEST(DisjointSets, TheKeptNumberStandsForBoth) {
    DisjointSets sets(4);
    EXPECT_EQ(sets.find(2), 2U);
    sets.join(3, 1);
    EXPECT_EQ(sets.find(1), 3U);
    sets.join(0, 1);
    EXPECT_EQ(sets.find(3), 0U);
    sets.join(0, 3);
    EXPECT_EQ(sets.find(1), 0U);
    EXPECT_EQ(sets.find(2), 2U);
}

TEST(DisjointSets, AgreesWithRelabellingByHand) {
    constexpr std::uint32_t count = 60;
    Random random(5);
    DisjointSets sets(count);
    std::vector<std::uint32_t> label(count);
    for (std::uint32_t i = 0; i < count; ++i)
        label[i] = i;
    for (int step = 0; step < 45; ++step) {
        const std::uint32_t a = random.below(count);
        const std::uint32_t b = random.below(count);
        sets.join(a, b);
        const std::uint32_t kept = label[a];
        const std::uint32_t gone = label[b];
        for (std::uint32_t& of : label) {
            if (of == gone) of = kept;
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            for (std::uint32_t j = 0; j < count; ++j)
                ASSERT_EQ(sets.find(i) == sets.find(j), label[i] == label[j]);
        }
    }
}

}  // namespace
}  // namespace roomscribe
