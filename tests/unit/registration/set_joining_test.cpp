// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/set_joining.hpp"

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/matchers.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using test::TransformNear;

/// Two scans of the L-shaped room, and two more of it or of another room.
struct TwoSets {
    std::vector<Transform> poses;
    std::vector<PreparedScan> scans;
    std::vector<RegistrationLink> links;

    explicit TwoSets(const Scenario& second_room) {
        const RegistrationScale scale{
            .coarse_voxel = 0.1, .fine_voxel = 0.04, .fpfh_radius = 0.5, .noise = 0.002};
        const std::vector<Vector3d> places = {
            {1.3, 2.2, 1.4}, {3.6, 2.0, 1.6}, {1.2, 3.0, 1.3}, {2.4, 1.6, 1.5}};
        for (std::size_t i = 0; i < places.size(); ++i) {
            Transform pose = Transform::Identity();
            pose.translation() = places[i];
            const Scenario room = i < 2 ? test::l_shaped_room() : second_room;
            poses.push_back(pose);
            scans.push_back(prepare_scan(test::simulate_scan(room, pose, i, 4.0), scale));
        }
        links = {link(1, 0, LinkVerdict::accepted), link(3, 2, LinkVerdict::accepted),
                 link(2, 1, LinkVerdict::ambiguous)};
    }

    Transform truth(std::size_t source, std::size_t target) const {
        return poses[target].inverse() * poses[source];
    }
    RegistrationLink link(std::size_t source, std::size_t target, LinkVerdict verdict) const {
        RegistrationLink result;
        result.source = source;
        result.target = target;
        result.target_from_source = truth(source, target);
        result.verdict = verdict;
        result.probability = verdict == LinkVerdict::accepted ? 0.99 : 0.6;
        return result;
    }
    void join() { join_sets(links, scans, {}, {}); }
};

/// Half a turn about the middle of the room.
Transform turned(const Transform& target_from_source) {
    Transform turn = Transform::Identity();
    turn.linear() = Eigen::AngleAxisd(3.14159, Vector3d::UnitZ()).toRotationMatrix();
    turn.translation() = Vector3d(-0.5, 0.5, 0.0);
    return turn * target_from_source;
}

TEST(JoinSets, TheScansAroundALinkTellItsPoses) {
    TwoSets sets(test::l_shaped_room());
    const Transform truth = sets.links[2].target_from_source;
    sets.links[2].rivals = {truth};
    sets.links[2].target_from_source = turned(truth);
    sets.join();
    EXPECT_EQ(sets.links[2].verdict, LinkVerdict::accepted);
    EXPECT_EQ(sets.links[2].loops, LoopCheck::resolved);
    EXPECT_GE(sets.links[2].probability, 0.95);
    EXPECT_THAT(sets.links[2].target_from_source, TransformNear(truth, 0.0, 0.0));
    EXPECT_TRUE(sets.links[2].rivals.empty());
}

TEST(JoinSets, OtherRoomsStayApart) {
    TwoSets sets(test::other_room());
    sets.links[2].rivals = {turned(sets.links[2].target_from_source)};
    sets.join();
    EXPECT_EQ(sets.links[2].verdict, LinkVerdict::ambiguous);
    EXPECT_EQ(sets.links[2].rivals.size(), 1U);
}

TEST(JoinSets, TwoScansAloneHaveNobodyToAsk) {
    TwoSets sets(test::l_shaped_room());
    sets.links.erase(sets.links.begin(), sets.links.begin() + 2);
    sets.join();
    ASSERT_EQ(sets.links.size(), 1U);
    EXPECT_EQ(sets.links[0].verdict, LinkVerdict::ambiguous);
}

}  // namespace
}  // namespace roomscribe
