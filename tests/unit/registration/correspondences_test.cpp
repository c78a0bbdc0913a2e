// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/correspondences.hpp"

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

std::uint32_t nearest_column(const Eigen::MatrixXf& data, const Eigen::VectorXf& query,
                             DescriptorMetric metric) {
    const Eigen::MatrixXf differences = data.colwise() - query;
    Eigen::Index best = 0;
    if (metric == DescriptorMetric::euclidean) {
        differences.colwise().squaredNorm().minCoeff(&best);
    } else {
        differences.cwiseAbs().colwise().sum().minCoeff(&best);
    }
    return static_cast<std::uint32_t>(best);
}

std::vector<Correspondence> match_by_brute_force(const Eigen::MatrixXf& source,
                                                 const Eigen::MatrixXf& target,
                                                 const MatchSettings& settings) {
    std::vector<Correspondence> matches;
    for (std::uint32_t i = 0; i < source.cols(); ++i) {
        const std::uint32_t forth = nearest_column(target, source.col(i), settings.metric);
        if (settings.method == MatchMethod::back_and_forth &&
            nearest_column(source, target.col(forth), settings.metric) != i) {
            continue;
        }
        const Eigen::VectorXf difference = source.col(i) - target.col(forth);
        matches.push_back({i, forth,
                           settings.metric == DescriptorMetric::euclidean
                               ? difference.norm()
                               : difference.lpNorm<1>()});
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

class MatchDescriptors : public testing::TestWithParam<MatchSettings> {};

TEST_P(MatchDescriptors, AgreesWithBruteForce) {
    Random random(1);
    // More columns than a block of the matrix products holds.
    const Eigen::MatrixXf source = whole_descriptors(random, 33, 700, 100);
    const Eigen::MatrixXf target = whole_descriptors(random, 33, 1300, 100);
    for (const int num_threads : {1, 3}) {
        expect_same(match_descriptors(source, target, GetParam(), test::with_threads(num_threads)),
                    match_by_brute_force(source, target, GetParam()));
    }
}

TEST_P(MatchDescriptors, LowerNumberWinsTies) {
    Random random(2);
    for (const Eigen::Index count : {10, 600, 1100}) {
        const Eigen::MatrixXf source = whole_descriptors(random, 5, count, 3);
        const Eigen::MatrixXf target = whole_descriptors(random, 5, count / 2 + 5, 3);
        expect_same(match_descriptors(source, target, GetParam()),
                    match_by_brute_force(source, target, GetParam()));
    }
}

TEST_P(MatchDescriptors, IsEmptyIfEitherSideIs) {
    const Eigen::MatrixXf none(4, 0);
    const Eigen::MatrixXf some = Eigen::MatrixXf::Ones(4, 3);
    EXPECT_TRUE(match_descriptors(none, some, GetParam()).empty());
    EXPECT_TRUE(match_descriptors(some, none, GetParam()).empty());
    EXPECT_TRUE(match_descriptors(none, none, GetParam()).empty());
    EXPECT_THROW(match_descriptors(some, Eigen::MatrixXf::Ones(5, 3), GetParam()), InvalidArgument);
}

TEST_P(MatchDescriptors, FindsTheCounterpartsOfAPermutation) {
    Random random(3);
    const Eigen::MatrixXf source = whole_descriptors(random, 33, 200, 100);
    const Eigen::MatrixXf target = source.rowwise().reverse();
    const auto matches = match_descriptors(source, target, GetParam());
    ASSERT_EQ(matches.size(), 200U);
    for (const Correspondence& match : matches) {
        EXPECT_EQ(match.target, 199U - match.source);
        EXPECT_EQ(match.distance, 0.0F);
    }
}

constexpr MatchMethod methods[] = {MatchMethod::one_to_one, MatchMethod::back_and_forth};
constexpr DescriptorMetric metrics[] = {DescriptorMetric::euclidean, DescriptorMetric::manhattan};

std::vector<MatchSettings> all_settings() {
    std::vector<MatchSettings> all;
    for (const MatchMethod method : methods) {
        for (const DescriptorMetric metric : metrics)
            all.push_back({.method = method, .metric = metric});
    }
    return all;
}

INSTANTIATE_TEST_SUITE_P(Settings, MatchDescriptors, testing::ValuesIn(all_settings()),
                         [](const auto& tested) {
                             const MatchSettings& settings = tested.param;
                             const auto method = static_cast<std::size_t>(settings.method);
                             const auto metric = static_cast<std::size_t>(settings.metric);
                             return std::string(enumerator_names(settings.method)[method]) + "_" +
                                    std::string(enumerator_names(settings.metric)[metric]);
                         });

}  // namespace
}  // namespace roomscribe
