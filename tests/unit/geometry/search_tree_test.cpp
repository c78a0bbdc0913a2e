// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/search_tree.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/shapes.hpp"

namespace roomscribe {
namespace {

/// All points by (distance, index), which is the order the tree promises.
std::vector<Neighbor> sort_all(const std::vector<Eigen::Vector3f>& points,
                               const Eigen::Vector3f& query) {
    std::vector<Neighbor> all;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        all.push_back({i, (points[i] - query).squaredNorm()});
    }
    std::sort(all.begin(), all.end(), [](const Neighbor& a, const Neighbor& b) {
        return std::pair(a.squared_distance, a.index) < std::pair(b.squared_distance, b.index);
    });
    return all;
}

void expect_same(const std::vector<Neighbor>& actual, const std::vector<Neighbor>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
        EXPECT_EQ(actual[i].index, expected[i].index);
        EXPECT_FLOAT_EQ(actual[i].squared_distance, expected[i].squared_distance);
    }
}

/// Small whole coordinates: distances are exact, most points have equals and every query has ties.
std::vector<Eigen::Vector3f> lattice_points(Random& random, std::size_t count, std::uint32_t edge) {
    std::vector<Eigen::Vector3f> points(count);
    for (Eigen::Vector3f& point : points) {
        for (float& coordinate : point)
            coordinate = static_cast<float>(random.below(edge));
    }
    return points;
}

TEST(SearchTree, NearestAgreesWithBruteForce) {
    Random random(1);
    const auto points = test::random_points(random, 800);
    const SearchTree tree(points);
    EXPECT_EQ(tree.size(), points.size());
    std::vector<Neighbor> found;
    for (const Eigen::Vector3f& query : test::random_points(random, 100, 1.5)) {
        const auto all = sort_all(points, query);
        EXPECT_EQ(tree.nearest(query).index, all.front().index);
        for (const std::size_t count : {1U, 2U, 17U, 100U}) {
            tree.nearest(query, count, found);
            expect_same(found, {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)});
        }
    }
}

TEST(SearchTree, LowerIndexWinsTies) {
    Random random(2);
    for (const std::uint32_t edge : {2U, 4U, 7U}) {
        const auto points = lattice_points(random, 500, edge);
        const SearchTree tree(points);
        std::vector<Neighbor> found;
        for (const Eigen::Vector3f& query : lattice_points(random, 50, edge)) {
            const auto all = sort_all(points, query);
            for (const std::size_t count : {1U, 5U, 40U}) {
                tree.nearest(query, count, found);
                expect_same(found, {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)});
            }
        }
    }
}

TEST(SearchTree, RadiusIsInclusiveAndAgreesWithBruteForce) {
    Random random(3);
    const auto points = lattice_points(random, 600, 9);
    const SearchTree tree(points);
    std::vector<Neighbor> found;
    for (const Eigen::Vector3f& query : lattice_points(random, 60, 9)) {
        for (const double radius : {0.0, 1.0, 3.0, 5.0}) {
            auto all = sort_all(points, query);
            std::erase_if(all, [radius](const Neighbor& neighbor) {
                return neighbor.squared_distance > radius * radius;
            });
            tree.within_radius(query, radius, found);
            expect_same(found, all);
        }
    }
}

TEST(SearchTree, ReturnsAllIfFewerThanAsked) {
    const std::vector<Eigen::Vector3f> points(5, Eigen::Vector3f(1, 2, 3));
    const SearchTree tree(points);
    std::vector<Neighbor> found(99);
    tree.nearest({0, 0, 0}, 50, found);
    ASSERT_EQ(found.size(), 5U);
    for (std::uint32_t i = 0; i < 5; ++i)
        EXPECT_EQ(found[i].index, i);
    tree.nearest({0, 0, 0}, 0, found);
    EXPECT_TRUE(found.empty());
    tree.within_radius({0, 0, 0}, 1.0, found);
    EXPECT_TRUE(found.empty());
}

TEST(SearchTree, MayBeEmptyAndMoved) {
    SearchTree tree(std::vector<Eigen::Vector3f>{});
    std::vector<Neighbor> found(3);
    tree.nearest({0, 0, 0}, 3, found);
    EXPECT_TRUE(found.empty());
    found.resize(3);
    tree.within_radius({0, 0, 0}, 1.0, found);
    EXPECT_TRUE(found.empty());

    // The tree has its own copy of the points.
    std::vector<Eigen::Vector3f> points = {{0, 0, 0}, {1, 0, 0}};
    tree = SearchTree(points);
    points.clear();
    const SearchTree moved = std::move(tree);
    EXPECT_EQ(moved.nearest({0.9F, 0, 0}).index, 1U);
}

}  // namespace
}  // namespace roomscribe
