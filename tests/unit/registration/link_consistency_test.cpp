// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/link_consistency.hpp"

#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using test::TransformNear;

std::vector<Transform> some_poses(std::size_t count) {
    Random random(1);
    std::vector<Transform> poses;
    for (std::size_t i = 0; i < count; ++i)
        poses.push_back(test::random_transform(random, 5.0));
    return poses;
}

RegistrationLink true_link(const std::vector<Transform>& poses, std::size_t source,
                           std::size_t target) {
    RegistrationLink link;
    link.source = source;
    link.target = target;
    link.target_from_source = poses[target].inverse() * poses[source];
    link.covariance = 1e-6 * Matrix6d::Identity();
    link.verdict = LinkVerdict::accepted;
    return link;
}

Transform half_turn_and_shift() {
    Transform motion = Transform::Identity();
    motion.linear() = Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    motion.translation() = Eigen::Vector3d(1.0, 0.5, 0.0);
    return motion;
}

TEST(CheckLoops, RejectsTheOneWrongLinkOfManyLoops) {
    const std::vector<Transform> poses = some_poses(4);
    std::vector<RegistrationLink> links;
    for (std::size_t source = 1; source < 4; ++source) {
        for (std::size_t target = 0; target < source; ++target)
            links.push_back(true_link(poses, source, target));
    }
    links[4].target_from_source = half_turn_and_shift() * links[4].target_from_source;
    check_loops(links, {});
    for (std::size_t i = 0; i < links.size(); ++i) {
        EXPECT_EQ(links[i].verdict, i == 4 ? LinkVerdict::rejected : LinkVerdict::accepted) << i;
        EXPECT_EQ(links[i].loops, i == 4 ? LoopCheck::disagrees : LoopCheck::agrees) << i;
    }
}

TEST(CheckLoops, OneLoopThatDoesNotCloseAccusesNobody) {
    const std::vector<Transform> poses = some_poses(3);
    std::vector<RegistrationLink> links = {true_link(poses, 1, 0), true_link(poses, 2, 1),
                                           true_link(poses, 2, 0)};
    links[2].target_from_source = half_turn_and_shift() * links[2].target_from_source;
    check_loops(links, {});
    for (const RegistrationLink& link : links) {
        EXPECT_EQ(link.verdict, LinkVerdict::accepted);
        EXPECT_EQ(link.loops, LoopCheck::none);
    }
}

TEST(CheckLoops, AnAmbiguousLinkTakesThePoseThatALoopLeadsTo) {
    const std::vector<Transform> poses = some_poses(3);
    std::vector<RegistrationLink> links = {true_link(poses, 1, 0), true_link(poses, 2, 1),
                                           true_link(poses, 2, 0)};
    const Transform truth = links[2].target_from_source;
    links[2].verdict = LinkVerdict::ambiguous;
    links[2].rivals = {truth};
    links[2].target_from_source = half_turn_and_shift() * truth;
    check_loops(links, {});
    EXPECT_EQ(links[2].verdict, LinkVerdict::accepted);
    EXPECT_EQ(links[2].loops, LoopCheck::resolved);
    EXPECT_THAT(links[2].target_from_source, TransformNear(truth, 1e-9, 1e-9));
}

TEST(CheckLoops, AnAmbiguousLinkThatSlidesFreelyStaysSo) {
    for (const std::size_t free : {1U, 2U}) {  // one of the chain, the link itself
        const std::vector<Transform> poses = some_poses(3);
        std::vector<RegistrationLink> links = {true_link(poses, 1, 0), true_link(poses, 2, 1),
                                               true_link(poses, 2, 0)};
        links[2].verdict = LinkVerdict::ambiguous;
        links[free].unobservable = {Vector6d::Unit(5)};
        check_loops(links, {});
        EXPECT_EQ(links[2].verdict, LinkVerdict::ambiguous);
    }
}

TEST(CheckLoops, AnAmbiguousLinkThatNoLoopClosesStaysSo) {
    const std::vector<Transform> poses = some_poses(3);
    std::vector<RegistrationLink> links = {true_link(poses, 1, 0), true_link(poses, 2, 0)};
    links[1].verdict = LinkVerdict::ambiguous;
    links[1].rivals = {half_turn_and_shift() * links[1].target_from_source};
    check_loops(links, {});
    EXPECT_EQ(links[1].verdict, LinkVerdict::ambiguous);
    EXPECT_EQ(links[1].loops, LoopCheck::none);
}

TEST(AreConsistent, ASlideAlongAFreeDirectionIsNoContradiction) {
    const std::vector<Transform> poses = some_poses(2);
    const RegistrationLink link = true_link(poses, 1, 0);
    RegistrationLink slid = link;
    slid.target_from_source.translation() += Eigen::Vector3d(2.0, 0.0, 0.0);
    EXPECT_FALSE(are_consistent(chain_of(link, {}), chain_of(slid, {})));
    slid.unobservable.emplace_back(Vector6d::Unit(3));
    EXPECT_TRUE(are_consistent(chain_of(link, {}), chain_of(slid, {})));
}

TEST(ChainedPose, GoesThereAndBack) {
    const std::vector<Transform> poses = some_poses(3);
    const ChainedPose first = chain_of(true_link(poses, 2, 1), {});
    const ChainedPose second = chain_of(true_link(poses, 1, 0), {});
    const ChainedPose both = second * first;
    EXPECT_THAT(both.target_from_source, TransformNear(poses[0].inverse() * poses[2], 1e-9, 1e-9));
    const ChainedPose back = reversed(reversed(both));
    EXPECT_THAT(back.target_from_source, TransformNear(both.target_from_source, 1e-9, 1e-9));
    EXPECT_LT((back.covariance - both.covariance).norm(), 1e-9 * both.covariance.norm());
    // The same error, met from either side.
    const RegistrationLink link = true_link(poses, 2, 1);
    EXPECT_LT((reversed(chain_of(link, {0.0, 0.0})).covariance - reversed(link).covariance).norm(),
              1e-12);
}

}  // namespace
}  // namespace roomscribe
