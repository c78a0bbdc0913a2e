// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/sample_consensus.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

/// Numbers below `size` of which those below `num_inliers` count; a model is one drawn number.
struct NumberProblem {
    using Model = std::uint32_t;
    std::uint32_t size = 100;
    std::uint32_t num_inliers = 50;
    int needed = 1;
    bool is_degenerate = false;

    std::size_t num_data() const { return size; }
    int sample_size() const { return needed; }
    std::optional<Model> propose(Random& random) const {
        std::uint32_t largest = 0;
        for (int i = 0; i < needed; ++i)
            largest = std::max(largest, random.below(size));
        return is_degenerate ? std::nullopt : std::optional(largest);
    }
    double score(const Model& model) const { return model < num_inliers ? num_inliers : 0.5; }
};

TEST(SampleConsensus, IterationFormula) {
    // 1 - (1 - 0.5^3)^n >= 0.99: the table of Fischler and Bolles says n = 35.
    EXPECT_EQ(std::ceil(consensus_iterations(0.5, 3, 0.99)), 35.0);
    EXPECT_EQ(std::ceil(consensus_iterations(0.5, 1, 0.999)), 10.0);
    EXPECT_EQ(consensus_iterations(1.0, 4, 0.999), 1.0);
    EXPECT_EQ(consensus_iterations(0.0, 3, 0.999), INFINITY);
    EXPECT_EQ(consensus_iterations(0.5, 3, 1.0), INFINITY);
    // Where 1 - ratio^size rounds to 1 a plain logarithm would return infinity.
    EXPECT_NEAR(consensus_iterations(1e-6, 3, 0.999) / (-std::log(0.001) * 1e18), 1.0, 1e-6);
}

TEST(SampleConsensus, StopsWhenConfident) {
    const auto result = sample_consensus(NumberProblem{}, 1, {.confidence = 0.999});
    EXPECT_EQ(result.stop, ConsensusStop::confident);
    EXPECT_LT(*result.model, 50U);
    EXPECT_EQ(result.score, 50.0);
    EXPECT_EQ(result.iterations, 10);
}

TEST(SampleConsensus, StopsAtOnceIfAllAreInliers) {
    const auto result = sample_consensus(NumberProblem{.num_inliers = 100, .needed = 3}, 1);
    EXPECT_EQ(result.stop, ConsensusStop::confident);
    EXPECT_EQ(result.iterations, 1);
}

TEST(SampleConsensus, StopsAtMaxIterations) {
    const auto result =
        sample_consensus(NumberProblem{.num_inliers = 2, .needed = 3}, 1, {.max_iterations = 50});
    EXPECT_EQ(result.stop, ConsensusStop::max_iterations);
    EXPECT_EQ(result.iterations, 50);
    EXPECT_TRUE(result.model);
}

TEST(SampleConsensus, HasNoModelFromDegenerateSamples) {
    const auto result =
        sample_consensus(NumberProblem{.is_degenerate = true}, 1, {.max_iterations = 20});
    EXPECT_EQ(result.stop, ConsensusStop::no_model);
    EXPECT_FALSE(result.model);
    EXPECT_EQ(result.iterations, 20);
}

TEST(SampleConsensus, HasNoModelFromTooLittleData) {
    const auto result = sample_consensus(NumberProblem{.size = 2, .needed = 3}, 1);
    EXPECT_EQ(result.stop, ConsensusStop::no_model);
    EXPECT_EQ(result.iterations, 0);
}

TEST(SampleConsensus, DependsOnTheSeedAlone) {
    std::set<std::uint32_t> models;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const auto first = sample_consensus(NumberProblem{}, seed);
        const auto second = sample_consensus(NumberProblem{}, seed);
        EXPECT_EQ(*first.model, *second.model);
        EXPECT_EQ(first.iterations, second.iterations);
        models.insert(*first.model);
    }
    EXPECT_GT(models.size(), 5U);
}

TEST(SampleConsensus, FindsTheInliersAsOftenAsItSays) {
    int num_failed = 0;
    constexpr int num_runs = 2000;
    for (std::uint64_t seed = 0; seed < num_runs; ++seed) {
        // The iterations that the formula asks for at the true ratio, and not one more.
        const double ratio = 0.3;
        const double needed = std::ceil(consensus_iterations(ratio, 2, 0.9));
        const auto result = sample_consensus(NumberProblem{.num_inliers = 30, .needed = 2}, seed,
                                             {.max_iterations = static_cast<int>(needed)});
        if (result.score < 30.0) ++num_failed;
    }
    EXPECT_LT(num_failed, 0.12 * num_runs);
    EXPECT_GT(num_failed, 0.06 * num_runs);
}

TEST(SampleConsensus, ChecksItsSettings) {
    EXPECT_THROW(sample_consensus(NumberProblem{}, 1, {.max_iterations = 0}), InvalidArgument);
    EXPECT_THROW(sample_consensus(NumberProblem{}, 1, {.confidence = 1.5}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
