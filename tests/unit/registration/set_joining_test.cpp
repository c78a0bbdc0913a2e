// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/set_joining.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/matchers.hpp"
#include "support/simulated_rooms.hpp"
#include "two_sets.hpp"

namespace roomscribe {
namespace {

using test::TransformNear;

void join(test::TwoSets& sets) {
    join_sets(sets.links, sets.scans, {}, {});
}

TEST(JoinSets, TheScansAroundALinkTellItsPoses) {
    test::TwoSets sets(test::l_shaped_room());
    const Transform truth = sets.links[2].target_from_source;
    sets.links[2].rivals = {truth};
    sets.links[2].target_from_source = test::turned(truth);
    join(sets);
    EXPECT_EQ(sets.links[2].verdict, LinkVerdict::accepted);
    EXPECT_EQ(sets.links[2].loops, LoopCheck::resolved);
    EXPECT_GE(sets.links[2].probability, 0.95);
    EXPECT_THAT(sets.links[2].target_from_source, TransformNear(truth, 0.0, 0.0));
    EXPECT_TRUE(sets.links[2].rivals.empty());
}

TEST(JoinSets, OtherRoomsStayApart) {
    test::TwoSets sets(test::other_room());
    sets.links[2].rivals = {test::turned(sets.links[2].target_from_source)};
    join(sets);
    EXPECT_EQ(sets.links[2].verdict, LinkVerdict::ambiguous);
    EXPECT_EQ(sets.links[2].rivals.size(), 1U);
}

TEST(JoinSets, TwoScansAloneHaveNobodyToAsk) {
    test::TwoSets sets(test::l_shaped_room());
    sets.links.erase(sets.links.begin(), sets.links.begin() + 2);
    join(sets);
    ASSERT_EQ(sets.links.size(), 1U);
    EXPECT_EQ(sets.links[0].verdict, LinkVerdict::ambiguous);
}

}  // namespace
}  // namespace roomscribe
