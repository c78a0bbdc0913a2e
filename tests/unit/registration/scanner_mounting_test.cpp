// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/scanner_mounting.hpp"

#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

Transform turned(double angle_deg, const Eigen::Vector3d& axis) {
    return Transform(Eigen::AngleAxisd(radians(angle_deg), axis));
}

const Transform yaw = turned(70.0, Eigen::Vector3d::UnitZ());
const Transform on_its_side = turned(90.0, Eigen::Vector3d::UnitX());
const Transform room_diagonal = turned(120.0, Eigen::Vector3d(1, 1, 1).normalized());

RegistrationLink link(std::size_t source, std::size_t target, const Transform& pose,
                      LinkVerdict verdict = LinkVerdict::accepted) {
    RegistrationLink result;
    result.source = source;
    result.target = target;
    result.target_from_source = pose;
    result.verdict = verdict;
    result.probability = 0.97;
    return result;
}

TEST(ScannerMounting, AnAcceptedPoseThatTiltsWhatOthersKeepUprightIsNone) {
    std::vector<UsualUp> ups(5);
    std::vector<RegistrationLink> links{link(1, 0, yaw), link(2, 1, yaw), link(3, 2, yaw),
                                        link(3, 1, yaw), link(4, 0, room_diagonal)};
    EXPECT_TRUE(drop_tilted_poses(links, ups));
    EXPECT_EQ(links[4].verdict, LinkVerdict::rejected);
    EXPECT_EQ(links[4].probability, 0.0);
    EXPECT_EQ(links[0].verdict, LinkVerdict::accepted);
    EXPECT_FALSE(drop_tilted_poses(links, ups));
}

TEST(ScannerMounting, OfAnAmbiguousLinkUprightPosesRemain) {
    std::vector<UsualUp> ups(4);
    std::vector<RegistrationLink> links{link(1, 0, yaw), link(2, 1, yaw),
                                        link(3, 2, on_its_side, LinkVerdict::ambiguous)};
    const Transform back = turned(180.0, Eigen::Vector3d::UnitZ());
    links[2].rivals = {room_diagonal, yaw, on_its_side, back};
    EXPECT_FALSE(drop_tilted_poses(links, ups));
    EXPECT_EQ(links[2].verdict, LinkVerdict::ambiguous);
    EXPECT_TRUE(links[2].target_from_source.isApprox(yaw));
    ASSERT_EQ(links[2].rivals.size(), 1U);
    EXPECT_TRUE(links[2].rivals[0].isApprox(back));
}

TEST(ScannerMounting, ScannersThatWereTurnedAtWillTellNothing) {
    std::vector<UsualUp> ups(4);
    std::vector<RegistrationLink> links{link(1, 0, yaw), link(2, 1, yaw), link(3, 2, on_its_side)};
    EXPECT_FALSE(drop_tilted_poses(links, ups));
    EXPECT_EQ(links[2].verdict, LinkVerdict::accepted);
    links.erase(links.begin());
    EXPECT_FALSE(drop_tilted_poses(links, ups));
    EXPECT_EQ(links[1].verdict, LinkVerdict::accepted);
}

TEST(ScannerMounting, FramesOfCamerasAreLeft) {
    std::vector<UsualUp> ups(4);
    for (UsualUp& up : ups)
        up.is_camera = true;
    std::vector<RegistrationLink> links{link(1, 0, yaw), link(2, 1, yaw), link(3, 1, yaw),
                                        link(2, 0, yaw), link(3, 2, on_its_side)};
    EXPECT_FALSE(drop_tilted_poses(links, ups));
    EXPECT_EQ(links[4].verdict, LinkVerdict::accepted);
}

}  // namespace
}  // namespace roomscribe
