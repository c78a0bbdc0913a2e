// SPDX-License-Identifier: MIT
#include "roomscribe/report/viewer_points.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "support/contexts.hpp"

namespace roomscribe {
namespace {

/// A floor of 4 x 4 m whose one corner was scanned a hundred times as densely, and a NaN.
Reconstruction uneven_floor() {
    Reconstruction result;
    Random random(3);
    for (int i = 0; i < 20'000; ++i) {
        const double side = i % 2 == 0 ? 4.0 : 0.4;
        result.map.cloud.positions.emplace_back(static_cast<float>(side * random.uniform()),
                                                static_cast<float>(side * random.uniform()), 0.0F);
    }
    result.map.cloud.positions.emplace_back(std::nanf(""), 0.0F, 0.0F);
    result.map.sections = {{"a", 0, 20'001, std::nullopt}};
    return result;
}

const Eigen::AlignedBox3d box{Eigen::Vector3d(-0.5, -0.5, -0.5), Eigen::Vector3d(4.5, 4.5, 2.5)};

TEST(GridPoints, KeepsEveryPlaceToTheStepOfTheGrid) {
    const Reconstruction result = uneven_floor();
    const GriddedPoints points = grid_points(result, box);
    EXPECT_GT(points.size(), 19'000U);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& place = points.places[i];
        const Eigen::Vector3d p =
            points.low + points.step * Eigen::Vector3d(place[0], place[1], place[2]);
        const Eigen::Vector3d truth = result.map.cloud.positions[points.numbers[i]].cast<double>();
        ASSERT_LT((p - truth).cwiseAbs().maxCoeff(), points.step);
    }
    const std::set<std::uint32_t> numbers(points.numbers.begin(), points.numbers.end());
    EXPECT_EQ(numbers.size(), points.size());
    EXPECT_FALSE(numbers.contains(20'000));
}

TEST(GridPoints, IsTheSameOnAnyNumberOfThreads) {
    const Reconstruction result = uneven_floor();
    EXPECT_EQ(grid_points(result, box, test::with_threads(1)).numbers,
              grid_points(result, box, test::with_threads(4)).numbers);
}

TEST(ThinPoints, MeetsTheBudgetAndIsEven) {
    const GriddedPoints points = grid_points(uneven_floor(), box);
    for (const std::size_t budget : {std::size_t{100}, std::size_t{1000}, std::size_t{5000}}) {
        const std::vector<std::uint32_t> chosen = thin_points(points, budget);
        EXPECT_LE(chosen.size(), budget);
        EXPECT_GT(chosen.size(), budget * 9 / 10);
        EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
        // The dense corner is a hundredth of the floor; half of the points lie there.
        const auto in_corner = std::count_if(chosen.begin(), chosen.end(), [&](std::uint32_t i) {
            const auto& place = points.places[i];
            return points.low.x() + points.step * place[0] < 0.4 &&
                   points.low.y() + points.step * place[1] < 0.4;
        });
        EXPECT_LT(static_cast<double>(in_corner), 0.05 * static_cast<double>(chosen.size()))
            << budget;
    }
    EXPECT_EQ(thin_points(points, 1'000'000).size(), points.size());
}

}  // namespace
}  // namespace roomscribe
