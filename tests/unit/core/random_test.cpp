// SPDX-License-Identifier: MIT
#include "roomscribe/core/random.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

TEST(Random, RepeatsForOneSeedAndStream) {
    Random a(42, 7);
    Random b(42, 7);
    for (int i = 0; i < 100; ++i)
        ASSERT_EQ(a.next(), b.next());
}

TEST(Random, StreamsAndSeedsDoNotMeet) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        for (std::uint64_t stream = 0; stream < 20; ++stream) {
            Random random(seed, stream);
            for (int i = 0; i < 25; ++i)
                seen.insert(random.next());
        }
    }
    EXPECT_EQ(seen.size(), 20U * 20U * 25U);
}

TEST(Random, NeighbouringStreamsAreUncorrelated) {
    double sum_of_products = 0.0;
    constexpr int count = 20'000;
    for (std::uint64_t stream = 0; stream < count; ++stream) {
        Random a(1, stream);
        Random b(1, stream + 1);
        sum_of_products += (a.uniform() - 0.5) * (b.uniform() - 0.5);
    }
    // The product has a standard deviation of 1/12.
    EXPECT_LT(std::abs(sum_of_products / count), 4.0 / 12.0 / std::sqrt(count));
}

TEST(Random, BelowKeepsItsBoundAndReachesEveryNumber) {
    Random random(3);
    std::array<int, 6> counts{};
    constexpr int count = 60'000;
    for (int i = 0; i < count; ++i)
        ++counts.at(random.below(6));
    double chi_squared = 0.0;
    for (const int n : counts)
        chi_squared += (n - 1e4) * (n - 1e4) / 1e4;
    EXPECT_LT(chi_squared, 25.7);  // 5 degrees of freedom, 1 in 10,000
    constexpr std::uint32_t largest = std::numeric_limits<std::uint32_t>::max();
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(random.below(1), 0U);
        EXPECT_LT(random.below(largest), largest);
    }
}

TEST(Random, UniformHasItsMoments) {
    Random random(4);
    double sum = 0.0;
    double sum_of_squares = 0.0;
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i) {
        const double value = random.uniform();
        ASSERT_GE(value, 0.0);
        ASSERT_LT(value, 1.0);
        sum += value;
        sum_of_squares += value * value;
    }
    EXPECT_NEAR(sum / count, 0.5, 4e-3);
    EXPECT_NEAR(sum_of_squares / count, 1.0 / 3.0, 4e-3);
    for (int i = 0; i < 1000; ++i) {
        const double value = random.uniform(-3.0, -1.0);
        EXPECT_GE(value, -3.0);
        EXPECT_LT(value, -1.0);
    }
}

TEST(Random, NormalHasItsMoments) {
    Random random(5);
    std::array<double, 5> moments{};
    constexpr int count = 200'000;
    for (int i = 0; i < count; ++i) {
        const double value = random.normal();
        ASSERT_TRUE(std::isfinite(value));
        for (std::size_t power = 1; power < moments.size(); ++power) {
            moments[power] += std::pow(value, static_cast<double>(power)) / count;
        }
    }
    EXPECT_NEAR(moments[1], 0.0, 0.01);
    EXPECT_NEAR(moments[2], 1.0, 0.015);
    EXPECT_NEAR(moments[3], 0.0, 0.04);
    EXPECT_NEAR(moments[4], 3.0, 0.1);
}

}  // namespace
}  // namespace roomscribe
