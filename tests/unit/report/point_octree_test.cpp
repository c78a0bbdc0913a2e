// SPDX-License-Identifier: MIT
#include "roomscribe/report/point_octree.hpp"

#include <array>
#include <set>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"

namespace roomscribe {
namespace {

GriddedPoints random_points() {
    Reconstruction result;
    Random random(5);
    for (int i = 0; i < 100'000; ++i) {
        const double side = i % 3 == 0 ? 8.0 : 0.5;
        result.map.cloud.positions.emplace_back(static_cast<float>(side * random.uniform()),
                                                static_cast<float>(side * random.uniform()),
                                                static_cast<float>(0.01 * random.uniform()));
    }
    return grid_points(result, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(8.0)});
}

TEST(PointOctree, HasEveryPointInOneNodeThatHoldsItsPlace) {
    const GriddedPoints points = random_points();
    const PointOctree octree = build_point_octree(points);
    ASSERT_EQ(octree.nodes.front().depth, 0);
    std::set<std::uint32_t> seen;
    std::set<std::pair<int, std::array<std::uint16_t, 3>>> places;
    for (const OctreeNode& node : octree.nodes) {
        EXPECT_TRUE(places.emplace(node.depth, node.place).second);
        for (const std::uint32_t i : node.points) {
            EXPECT_TRUE(seen.insert(i).second);
            for (std::size_t axis = 0; axis < 3; ++axis)
                ASSERT_EQ(points.places[i][axis] >> (16 - node.depth), node.place[axis]);
        }
    }
    EXPECT_EQ(seen.size(), points.size());
    EXPECT_GT(octree.nodes.size(), 10U);
}

TEST(PointOctree, ShowsEveryCellOfTheRootThatHasAPoint) {
    const GriddedPoints points = random_points();
    const PointOctree octree = build_point_octree(points);
    const auto cell_of = [&](std::uint32_t i) {
        std::array<int, 3> cell{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            cell[axis] = points.places[i][axis] / (65536 / static_cast<int>(PointOctree::cells));
        return cell;
    };
    std::set<std::array<int, 3>> filled;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        filled.insert(cell_of(i));
    std::set<std::array<int, 3>> shown;
    for (const std::uint32_t i : octree.nodes.front().points)
        EXPECT_TRUE(shown.insert(cell_of(i)).second);
    EXPECT_EQ(shown, filled);
}

TEST(PointOctree, IsEmptyWithoutPoints) {
    EXPECT_TRUE(build_point_octree({}).nodes.empty());
}

}  // namespace
}  // namespace roomscribe
