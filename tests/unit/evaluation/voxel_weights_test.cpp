// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/voxel_weights.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "support/contexts.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

TEST(VoxelWeights, AreOneOverThePointsOfTheVoxel) {
    Random random(1);
    std::vector<Eigen::Vector3f> points = test::random_points(random, 200'000, 1.0);
    points[5].x() = std::numeric_limits<float>::quiet_NaN();
    points[7].z() = std::numeric_limits<float>::infinity();
    const double size = 0.05;
    std::map<std::array<int, 3>, int> counts;
    const auto voxel_of = [&](const Eigen::Vector3f& point) {
        std::array<int, 3> voxel{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            voxel[axis] = static_cast<int>(
                std::floor(static_cast<double>(point[static_cast<int>(axis)]) / size));
        }
        return voxel;
    };
    for (const Eigen::Vector3f& point : points) {
        if (point.allFinite()) ++counts[voxel_of(point)];
    }
    const std::vector<float> weights = voxel_weights(points, size, test::with_threads(1));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float expected =
            points[i].allFinite() ? 1.0F / static_cast<float>(counts[voxel_of(points[i])]) : 0.0F;
        ASSERT_EQ(weights[i], expected) << i;
    }
    EXPECT_EQ(filled_voxels(points, size).size(), counts.size());
    EXPECT_EQ(voxel_weights(points, size, test::with_threads(4)), weights);
}

TEST(VoxelWeights, TakePointsHoweverFar) {
    const std::vector<Eigen::Vector3f> points{{1e30F, 0, 0}, {2e30F, 0, 0}, {-1e30F, 0, 0}};
    EXPECT_EQ(voxel_weights(points, 0.05), (std::vector<float>{0.5F, 0.5F, 1.0F}));
    EXPECT_TRUE(voxel_weights({}, 0.05).empty());
    EXPECT_TRUE(filled_voxels({}, 0.05).empty());
}

}  // namespace
}  // namespace roomscribe
