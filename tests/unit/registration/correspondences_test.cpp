// SPDX-License-Identifier: MIT
#include "roomscribe/registration/correspondences.hpp"

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/contexts.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

/// Descriptors of whole numbers: all distances are exact, and `range` small makes ties.
Eigen::MatrixXf whole_descriptors(Random& random, Eigen::Index rows, Eigen::Index columns,
                                  std::uint32_t range) {
    return Eigen::MatrixXf::NullaryExpr(rows, columns,
                                        [&] { return static_cast<float>(random.below(range)); });
}

std::uint32_t nearest_column(const Eigen::MatrixXf& data, const Eigen::VectorXf& query) {
    Eigen::Index best = 0;
    (data.colwise() - query).colwise().squaredNorm().minCoeff(&best);
    return static_cast<std::uint32_t>(best);
}

std::vector<Correspondence> match_by_brute_force(const Eigen::MatrixXf& source,
                                                 const Eigen::MatrixXf& target,
                                                 MatchMethod method) {
    std::vector<Correspondence> matches;
    for (std::uint32_t i = 0; i < source.cols(); ++i) {
        const std::uint32_t forth = nearest_column(target, source.col(i));
        if (method == MatchMethod::back_and_forth &&
            nearest_column(source, target.col(forth)) != i) {
            continue;
        }
        matches.push_back({i, forth, (source.col(i) - target.col(forth)).norm()});
    }
    return matches;
}

void expect_same(const std::vector<Correspondence>& actual,
                 const std::vector<Correspondence>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
        EXPECT_EQ(actual[i].source, expected[i].source);
        EXPECT_EQ(actual[i].target, expected[i].target);
        EXPECT_FLOAT_EQ(actual[i].distance, expected[i].distance);
    }
}

class MatchDescriptors : public testing::TestWithParam<MatchMethod> {};

TEST_P(MatchDescriptors, AgreesWithBruteForce) {
    Random random(1);
    // More columns than a block of the matrix products holds.
    const Eigen::MatrixXf source = whole_descriptors(random, 33, 700, 100);
    const Eigen::MatrixXf target = whole_descriptors(random, 33, 1300, 100);
    for (const int num_threads : {1, 3}) {
        expect_same(match_descriptors(source, target, {.method = GetParam()},
                                      test::with_threads(num_threads)),
                    match_by_brute_force(source, target, GetParam()));
    }
}

TEST_P(MatchDescriptors, LowerNumberWinsTies) {
    Random random(2);
    for (const Eigen::Index count : {10, 600, 1100}) {
        const Eigen::MatrixXf source = whole_descriptors(random, 5, count, 3);
        const Eigen::MatrixXf target = whole_descriptors(random, 5, count / 2 + 5, 3);
        expect_same(match_descriptors(source, target, {.method = GetParam()}),
                    match_by_brute_force(source, target, GetParam()));
    }
}

TEST_P(MatchDescriptors, IsEmptyIfEitherSideIs) {
    const Eigen::MatrixXf none(4, 0);
    const Eigen::MatrixXf some = Eigen::MatrixXf::Ones(4, 3);
    EXPECT_TRUE(match_descriptors(none, some, {.method = GetParam()}).empty());
    EXPECT_TRUE(match_descriptors(some, none, {.method = GetParam()}).empty());
    EXPECT_TRUE(match_descriptors(none, none, {.method = GetParam()}).empty());
    EXPECT_THROW(match_descriptors(some, Eigen::MatrixXf::Ones(5, 3), {.method = GetParam()}),
                 InvalidArgument);
}

TEST_P(MatchDescriptors, FindsTheCounterpartsOfAPermutation) {
    Random random(3);
    const Eigen::MatrixXf source = whole_descriptors(random, 33, 200, 100);
    const Eigen::MatrixXf target = source.rowwise().reverse();
    const auto matches = match_descriptors(source, target, {.method = GetParam()});
    ASSERT_EQ(matches.size(), 200U);
    for (const Correspondence& match : matches) {
        EXPECT_EQ(match.target, 199U - match.source);
        EXPECT_EQ(match.distance, 0.0F);
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, MatchDescriptors,
                         testing::Values(MatchMethod::one_to_one, MatchMethod::back_and_forth),
                         [](const auto& method) {
                             return std::string(enumerator_names(
                                 method.param)[static_cast<std::size_t>(method.param)]);
                         });

}  // namespace
}  // namespace roomscribe
