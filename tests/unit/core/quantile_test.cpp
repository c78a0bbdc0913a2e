// SPDX-License-Identifier: MIT
#include "roomscribe/core/quantile.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

TEST(Quantile, is_the_value_of_that_rank) {
    std::vector<double> values{5.0, 1.0, 4.0, 2.0, 3.0};
    EXPECT_EQ(quantile(values, 0.0), 1.0);
    EXPECT_EQ(quantile(values, 0.25), 2.0);
    EXPECT_EQ(quantile(values, 1.0), 5.0);
    EXPECT_EQ(median(values), 3.0);
}

TEST(Quantile, the_median_of_an_even_number_is_the_upper_one) {
    std::vector<float> values{4.0F, 1.0F, 3.0F, 2.0F};
    EXPECT_EQ(median(values), 3.0F);
    values = {1.0F, std::numeric_limits<float>::infinity()};
    EXPECT_EQ(median(values), std::numeric_limits<float>::infinity());
}

TEST(Quantile, of_none_is_zero) {
    std::vector<double> none;
    EXPECT_EQ(quantile(none, 0.5), 0.0);
}

}  // namespace
}  // namespace roomscribe
