// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/set_contradiction.hpp"

#include <gtest/gtest.h>

#include "support/simulated_rooms.hpp"
#include "two_sets.hpp"

namespace roomscribe {
namespace {

constexpr double min_ambiguous = 0.5;

bool reject(test::TwoSets& sets) {
    return reject_what_sets_contradict(sets.links, sets.scans, min_ambiguous);
}

TEST(RejectWhatSetsContradict, LeavesRightLinksAlone) {
    test::TwoSets sets(test::l_shaped_room());
    sets.links[2].verdict = LinkVerdict::accepted;
    EXPECT_FALSE(reject(sets));
    for (const RegistrationLink& link : sets.links)
        EXPECT_EQ(link.verdict, LinkVerdict::accepted);
}

TEST(RejectWhatSetsContradict, RejectsTheWrongLinkAndNoneThatItSpeaksAgainst) {
    test::TwoSets sets(test::l_shaped_room());
    sets.links[2].verdict = LinkVerdict::accepted;
    sets.links[2].target_from_source = test::turned(sets.links[2].target_from_source);
    EXPECT_TRUE(reject(sets));
    EXPECT_EQ(sets.links[0].verdict, LinkVerdict::accepted);
    EXPECT_EQ(sets.links[1].verdict, LinkVerdict::accepted);
    EXPECT_EQ(sets.links[2].verdict, LinkVerdict::rejected);
    EXPECT_EQ(sets.links[2].loops, LoopCheck::disagrees);
}

TEST(RejectWhatSetsContradict, HearsAmbiguousLinksThatPlaceScans) {
    test::TwoSets sets(test::l_shaped_room());
    sets.links[2].target_from_source = test::turned(sets.links[2].target_from_source);
    EXPECT_FALSE(reject(sets));
    EXPECT_EQ(sets.links[2].verdict, LinkVerdict::rejected);
}

TEST(RejectWhatSetsContradict, LeavesWhatPlacesNothing) {
    test::TwoSets sets(test::l_shaped_room());
    sets.links[2].target_from_source = test::turned(sets.links[2].target_from_source);
    sets.links[2].probability = 0.3;
    EXPECT_FALSE(reject(sets));
    EXPECT_EQ(sets.links[2].verdict, LinkVerdict::ambiguous);
}

}  // namespace
}  // namespace roomscribe
