// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/outlier_removal.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

std::vector<std::uint32_t> keep(const std::vector<Eigen::Vector3f>& points,
                                const OutlierSettings& settings = {}) {
    return remove_outliers(points, SearchTree(points), settings);
}

/// A wall with noise, as a scanner `distance` before its middle samples it: density falls with
/// range.
std::vector<Eigen::Vector3f> scanned_wall(Random& random, double distance, std::size_t count) {
    std::vector<Eigen::Vector3f> points;
    while (points.size() < count) {
        const Eigen::Vector3d direction = test::random_direction(random);
        if (direction.x() < 0.25) continue;
        Eigen::Vector3d point = direction * (distance / direction.x());
        point.x() += 0.005 * random.normal();
        points.emplace_back(point.cast<float>());
    }
    return points;
}

TEST(RemoveOutliers, TakesOutGrossOutliers) {
    Random random(1);
    auto points = scanned_wall(random, 2.0, 5000);
    const std::size_t num_wall = points.size();
    for (int i = 0; i < 50; ++i) {
        points.emplace_back((-3.0 * test::random_direction(random)).cast<float>());
        points.back().x() -= 20.0F + static_cast<float>(3 * i);
    }
    const auto kept = keep(points);
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
    EXPECT_TRUE(std::all_of(kept.begin(), kept.end(),
                            [num_wall](std::uint32_t index) { return index < num_wall; }));
    EXPECT_GT(kept.size(), num_wall * 99 / 100);
}

TEST(RemoveOutliers, KeepsSurfaceWhoseDensityFallsWithRange) {
    // From the foot of the perpendicular to 75 degrees off it the spacing grows eightfold.
    Random random(2);
    const auto points = scanned_wall(random, 1.0, 20'000);
    const auto kept = keep(points);
    EXPECT_GT(kept.size(), points.size() * 99 / 100);
}

TEST(RemoveOutliers, KeepsTheInsideOfARegularGrid) {
    // All spacings are equal, so that the deviations vanish.
    const auto points = test::grid_points(40, 40, 0.125);
    EXPECT_GE(keep(points).size(), 38U * 38U);
}

TEST(RemoveOutliers, KeepsDuplicates) {
    Random random(3);
    auto points = scanned_wall(random, 2.0, 2000);
    points.insert(points.end(), 20, points.front());
    const auto kept = keep(points);
    EXPECT_EQ(std::count_if(kept.begin(), kept.end(), [](std::uint32_t i) { return i >= 2000; }),
              20);
}

TEST(RemoveOutliers, ManagesFewPoints) {
    EXPECT_TRUE(keep({}).empty());
    EXPECT_EQ(keep({{1, 2, 3}}).size(), 1U);
    EXPECT_EQ(keep({{0, 0, 0}, {1, 0, 0}}).size(), 2U);
    EXPECT_EQ(keep(std::vector<Eigen::Vector3f>(30, Eigen::Vector3f(1, 2, 3))).size(), 30U);
}

TEST(RemoveOutliers, MoreDeviationsKeepMore) {
    Random random(4);
    const auto points = scanned_wall(random, 2.0, 3000);
    std::size_t previous = 0;
    for (const double deviations : {0.0, 1.0, 2.0, 4.0}) {
        const std::size_t kept = keep(points, {.max_deviations = deviations}).size();
        EXPECT_GT(kept, previous);
        previous = kept;
    }
    EXPECT_EQ(keep(points, {.max_deviations = 1e6}).size(), points.size());
    EXPECT_THROW(keep(points, {.num_neighbors = 0}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
