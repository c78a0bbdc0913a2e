// SPDX-License-Identifier: MIT
#include "roomscribe/structure/euclidean_clusters.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Clusters = std::vector<std::vector<std::uint32_t>>;

TEST(EuclideanClusters, HangTogetherByShortSteps) {
    const std::vector<Eigen::Vector3f> points{{0, 0, 0}, {5, 0, 0}, {1, 0, 0},
                                              {2, 0, 0}, {6, 0, 0}, {9, 0, 0}};
    const std::vector<std::uint32_t> all{0, 1, 2, 3, 4, 5};
    EXPECT_EQ(euclidean_clusters(points, all, 1.1), (Clusters{{0, 2, 3}, {1, 4}, {5}}));
    // Without the middle one, the ends are apart.
    const std::vector<std::uint32_t> some{0, 3, 5};
    EXPECT_EQ(euclidean_clusters(points, some, 1.1), (Clusters{{0}, {3}, {5}}));
    EXPECT_TRUE(euclidean_clusters(points, {}, 1.1).empty());
}

/// Numbers of sets by joining every near pair over and over.
std::vector<std::uint32_t> brute_force(const std::vector<Eigen::Vector3f>& points, float reach) {
    std::vector<std::uint32_t> set(points.size());
    for (std::uint32_t i = 0; i < set.size(); ++i)
        set[i] = i;
    for (bool changes = true; changes;) {
        changes = false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < points.size(); ++j) {
                if ((points[i] - points[j]).norm() > reach || set[j] <= set[i]) continue;
                set[j] = set[i];
                changes = true;
            }
        }
    }
    return set;
}

TEST(EuclideanClusters, AgreeWithBruteForce) {
    Random random(7);
    const std::vector<Eigen::Vector3f> points = test::random_points(random, 300);
    std::vector<std::uint32_t> all(points.size());
    for (std::uint32_t i = 0; i < all.size(); ++i)
        all[i] = i;
    const std::vector<std::uint32_t> expected = brute_force(points, 0.2F);
    const Clusters clusters = euclidean_clusters(points, all, 0.2);
    std::size_t count = 0;
    for (const std::vector<std::uint32_t>& cluster : clusters) {
        EXPECT_TRUE(std::is_sorted(cluster.begin(), cluster.end()));
        count += cluster.size();
        for (const std::uint32_t point : cluster)
            EXPECT_EQ(expected[point], cluster.front());
    }
    EXPECT_EQ(count, points.size());
    EXPECT_GT(clusters.size(), 5U);
}

}  // namespace
}  // namespace roomscribe
