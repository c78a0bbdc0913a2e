// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/correspondence_rejection.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "point_matches.hpp"
#include "roomscribe/core/error.hpp"
#include "support/matchers.hpp"

namespace roomscribe {
namespace {

using test::TransformNear;

std::vector<PointMatch> true_matches(Random& random, const Transform& motion, std::size_t count,
                                     double noise = 0.0) {
    std::vector<PointMatch> matches;
    for (std::size_t i = 0; i < count; ++i) {
        matches.push_back(test::true_match(random, motion, noise));
    }
    return matches;
}

TEST(FitTransform, IsExactForExactMatches) {
    Random random(1);
    for (int run = 0; run < 50; ++run) {
        const Transform motion = test::random_transform(random, 5.0);
        for (const std::size_t count : {3U, 4U, 50U}) {
            const auto fitted = fit_transform(true_matches(random, motion, count));
            ASSERT_TRUE(fitted);
            EXPECT_THAT(*fitted, TransformNear(motion, 1e-9, 1e-9));
        }
    }
}

TEST(FitTransform, WeightsCountAsRepeats) {
    Random random(2);
    const auto matches = true_matches(random, test::random_transform(random), 10, 0.3);
    std::vector<PointMatch> repeated = matches;
    std::vector<double> weights(matches.size(), 1.0);
    for (const std::size_t i : {2U, 7U}) {
        weights[i] = 3.0;
        repeated.push_back(matches[i]);
        repeated.push_back(matches[i]);
    }
    EXPECT_THAT(*fit_transform(matches, weights),
                TransformNear(*fit_transform(repeated), 1e-12, 1e-12));
}

TEST(FitTransform, WeightZeroTakesNoPart) {
    Random random(3);
    const Transform motion = test::random_transform(random);
    auto matches = true_matches(random, motion, 10);
    matches.push_back(test::false_match(random));
    std::vector<double> weights(matches.size(), 0.5);
    weights.back() = 0.0;
    EXPECT_THAT(*fit_transform(matches, weights), TransformNear(motion, 1e-9, 1e-9));
    EXPECT_FALSE(fit_transform(matches, std::vector<double>(matches.size(), 0.0)));
}

TEST(FitTransform, LeavesTheLeastSquares) {
    Random random(4);
    const auto matches = true_matches(random, test::random_transform(random), 30, 0.2);
    const Transform fitted = *fit_transform(matches);
    const auto error_of = [&matches](const Transform& motion) {
        double sum = 0.0;
        for (const PointMatch& match : matches) {
            sum += (motion * match.source - match.target).squaredNorm();
        }
        return sum;
    };
    for (int i = 0; i < 100; ++i) {
        EXPECT_GT(error_of(test::small_transform(random, 1e-3, 1e-3) * fitted), error_of(fitted));
    }
}

TEST(FitTransform, IsEmptyOnALineAndForFewMatches) {
    Random random(5);
    const Transform motion = test::random_transform(random);
    EXPECT_FALSE(fit_transform(true_matches(random, motion, 2)));
    EXPECT_FALSE(fit_transform({}));
    EXPECT_FALSE(fit_transform(std::vector<PointMatch>(5, test::true_match(random, motion))));
    const Eigen::Vector3d direction = test::random_direction(random);
    std::vector<PointMatch> line(6);
    for (std::size_t i = 0; i < line.size(); ++i) {
        line[i].source = direction * static_cast<double>(i);
        line[i].target = motion * line[i].source;
    }
    EXPECT_FALSE(fit_transform(line));
}

TEST(FitTransform, IsNeverAReflection) {
    Random random(6);
    for (int run = 0; run < 200; ++run) {
        auto matches = true_matches(random, Transform::Identity(), 3U + random.below(5));
        for (PointMatch& match : matches)
            match.target.x() *= -1.0;
        if (const auto fitted = fit_transform(matches)) {
            EXPECT_NEAR(fitted->linear().determinant(), 1.0, 1e-9);
        }
    }
}

class Rejection : public testing::TestWithParam<double> {};

TEST_P(Rejection, KeepsTheTrueMatchesAmongFalseOnes) {
    const double outlier_share = GetParam();
    Random random(7);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const Transform motion = test::random_transform(random, 3.0);
        std::vector<PointMatch> matches;
        std::vector<bool> is_true;
        for (int i = 0; i < 300; ++i) {
            is_true.push_back(random.uniform() >= outlier_share);
            matches.push_back(is_true.back() ? test::true_match(random, motion, 0.02)
                                             : test::false_match(random));
        }
        const RejectionResult result = reject_by_sample_consensus(matches, seed);
        ASSERT_TRUE(result.target_from_source);
        EXPECT_EQ(result.stop, ConsensusStop::confident);
        EXPECT_THAT(*result.target_from_source, TransformNear(motion, 0.02, radians(0.5)));
        EXPECT_TRUE(std::is_sorted(result.inliers.begin(), result.inliers.end()));
        const auto num_kept_true = std::count_if(result.inliers.begin(), result.inliers.end(),
                                                 [&](std::uint32_t i) { return is_true[i]; });
        EXPECT_EQ(num_kept_true, std::count(is_true.begin(), is_true.end(), true));
        EXPECT_LT(static_cast<long>(result.inliers.size()) - num_kept_true, 3);
    }
}

INSTANTIATE_TEST_SUITE_P(OutlierShares, Rejection, testing::Values(0.0, 0.5, 0.65, 0.8));

TEST(RejectionResult, RepeatsForOneSeed) {
    Random random(8);
    std::vector<PointMatch> matches =
        true_matches(random, test::random_transform(random), 40, 0.05);
    for (int i = 0; i < 40; ++i)
        matches.push_back(test::false_match(random));
    const RejectionResult first = reject_by_sample_consensus(matches, 5);
    const RejectionResult second = reject_by_sample_consensus(matches, 5);
    EXPECT_EQ(first.inliers, second.inliers);
    EXPECT_EQ(first.iterations, second.iterations);
    EXPECT_EQ(first.target_from_source->matrix(), second.target_from_source->matrix());
}

TEST(RejectionResult, FindsNothingInTooLittle) {
    Random random(9);
    const auto matches = true_matches(random, test::random_transform(random), 2);
    const RejectionResult result = reject_by_sample_consensus(matches, 1);
    EXPECT_FALSE(result.target_from_source);
    EXPECT_TRUE(result.inliers.empty());
    EXPECT_EQ(result.stop, ConsensusStop::no_model);
    EXPECT_THROW(reject_by_sample_consensus(matches, 1, {.inlier_distance = 0.0}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
