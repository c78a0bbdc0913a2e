// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_candidates.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "point_matches.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"

namespace roomscribe {
namespace {

bool has_pose(const std::vector<PoseCandidate>& candidates, const Transform& pose) {
    return std::any_of(candidates.begin(), candidates.end(), [&](const PoseCandidate& candidate) {
        return testing::Value(candidate.target_from_source,
                              test::TransformNear(pose, 0.05, radians(1.5)));
    });
}

TEST(ProposePoses, FindsThePoseAmongFalseMatches) {
    Random random(1);
    for (int run = 0; run < 5; ++run) {
        const Transform pose = test::random_transform(random, 3.0);
        std::vector<PointMatch> matches;
        for (int i = 0; i < 400; ++i) {
            matches.push_back(i % 10 == 0 ? test::true_match(random, pose, 0.02)
                                          : test::false_match(random));
        }
        const auto candidates = propose_poses(matches);
        ASSERT_FALSE(candidates.empty());
        EXPECT_THAT(candidates.front().target_from_source,
                    test::TransformNear(pose, 0.05, radians(1.5)));
        EXPECT_GE(candidates.front().num_inliers, 38U);
    }
}

TEST(ProposePoses, BringsBackBothOfTwoEqualPoses) {
    // The same room, and the same room turned by half a turn: as many matches for either.
    Random random(2);
    const Transform first = test::random_transform(random, 3.0);
    const Transform second =
        first * Transform(Eigen::AngleAxisd(radians(180.0), Eigen::Vector3d::UnitZ()));
    std::vector<PointMatch> matches;
    for (int i = 0; i < 60; ++i)
        matches.push_back(test::true_match(random, first, 0.02));
    for (int i = 0; i < 60; ++i)
        matches.push_back(test::true_match(random, second, 0.02));
    for (int i = 0; i < 200; ++i)
        matches.push_back(test::false_match(random));
    const auto candidates = propose_poses(matches);
    ASSERT_GE(candidates.size(), 2U);
    const std::vector<PoseCandidate> best(candidates.begin(), candidates.begin() + 2);
    EXPECT_TRUE(has_pose(best, first));
    EXPECT_TRUE(has_pose(best, second));
}

TEST(ProposePoses, AreSortedDifferentAndNotTooMany) {
    Random random(3);
    std::vector<PointMatch> matches;
    for (const int support : {20, 80, 40, 60}) {
        const Transform pose = test::random_transform(random, 3.0);
        for (int i = 0; i < support; ++i)
            matches.push_back(test::true_match(random, pose, 0.02));
    }
    const CompatibilitySettings settings{.min_difference = 0.4, .max_candidates = 3};
    const auto candidates = propose_poses(matches, settings);
    ASSERT_EQ(candidates.size(), 3U);
    EXPECT_GE(candidates[0].num_inliers, 78U);
    EXPECT_GE(candidates[1].num_inliers, 58U);
    EXPECT_GE(candidates[2].num_inliers, 38U);
    EXPECT_GE(candidates[0].num_inliers, candidates[1].num_inliers);
    EXPECT_GE(candidates[1].num_inliers, candidates[2].num_inliers);

    std::vector<Eigen::Vector3f> sources;
    for (const PointMatch& match : matches)
        sources.push_back(match.source.cast<float>());
    const PointSpread spread = measure_spread(sources);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_GE(rms_displacement(spread, candidates[i].target_from_source,
                                       candidates[j].target_from_source),
                      settings.min_difference);
        }
    }
}

TEST(ProposePoses, HasTheSameBitsOnAnyThreads) {
    Random random(4);
    const Transform pose = test::random_transform(random);
    std::vector<PointMatch> matches;
    for (int i = 0; i < 300; ++i) {
        matches.push_back(i % 4 == 0 ? test::true_match(random, pose, 0.03)
                                     : test::false_match(random));
    }
    const auto one = propose_poses(matches, {}, test::with_threads(1));
    for (const int num_threads : {2, 7}) {
        const auto many = propose_poses(matches, {}, test::with_threads(num_threads));
        ASSERT_EQ(many.size(), one.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            EXPECT_EQ(many[i].num_inliers, one[i].num_inliers);
            EXPECT_EQ(many[i].target_from_source.matrix(), one[i].target_from_source.matrix());
        }
    }
}

TEST(ProposePoses, FindsNothingInTooLittle) {
    Random random(5);
    const Transform pose = test::random_transform(random);
    EXPECT_TRUE(propose_poses({}).empty());
    EXPECT_TRUE(propose_poses(std::vector<PointMatch>(1, test::true_match(random, pose))).empty());
    EXPECT_TRUE(propose_poses(std::vector<PointMatch>(9, test::true_match(random, pose))).empty());
}

}  // namespace
}  // namespace roomscribe
