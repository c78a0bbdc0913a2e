// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/voxel_grid.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Cell = std::array<long, 3>;

struct CellSum {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::uint32_t count = 0;
};

/// Every cell by itself, in the order of the cells.
std::map<Cell, CellSum> sums_by_cell(const std::vector<Eigen::Vector3f>& points, double size) {
    std::map<Cell, CellSum> cells;
    for (const Eigen::Vector3f& point : points) {
        if (!point.allFinite()) continue;
        Cell cell{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double coordinate = point[static_cast<Eigen::Index>(axis)];
            cell[axis] = std::lround(std::floor(coordinate * (1.0 / size)));
        }
        cells[cell].sum += point.cast<double>();
        ++cells[cell].count;
    }
    return cells;
}

PointCloud cloud_of(std::vector<Eigen::Vector3f> positions) {
    PointCloud cloud;
    cloud.positions = std::move(positions);
    return cloud;
}

void shuffle(std::vector<Eigen::Vector3f>& points, Random& random) {
    for (std::size_t i = points.size(); i > 1; --i) {
        std::swap(points[i - 1], points[random.below(static_cast<std::uint32_t>(i))]);
    }
}

RC_GTEST_PROP(VoxelGrid, AgreesWithAMapOfCells, (std::uint32_t seed)) {
    Random random(seed);
    const double size = random.uniform(0.01, 0.7);
    auto points = test::random_points(random, random.below(3000), random.uniform(0.1, 4.0));
    for (std::size_t i = 0; i + 1 < points.size(); i += 50)
        points[i] = points[i + 1];
    for (std::size_t i = 20; i < points.size(); i += 100)
        points[i].x() = NAN;
    const VoxelGrid grid = downsample_voxel_grid(cloud_of(points), {.voxel_size = size});
    const auto cells = sums_by_cell(points, size);

    RC_ASSERT(grid.cloud.size() == cells.size());
    RC_ASSERT(grid.num_points.size() == cells.size());
    std::size_t voxel = 0;
    for (const auto& [cell, sum] : cells) {
        const Eigen::Vector3d centroid = sum.sum / sum.count;
        RC_ASSERT(grid.num_points[voxel] == sum.count);
        RC_ASSERT((grid.cloud.positions[voxel].cast<double>() - centroid).norm() < 1e-6);
        ++voxel;
    }
}

TEST(VoxelGrid, TellsTheVoxelOfEveryPoint) {
    Random random(2);
    auto points = test::random_points(random, 2000);
    points[7].y() = NAN;
    points[8].z() = -INFINITY;
    const VoxelGrid grid = downsample_voxel_grid(cloud_of(points), {.voxel_size = 0.3});
    ASSERT_EQ(grid.voxel_of_point.size(), points.size());
    std::vector<std::uint32_t> counts(grid.cloud.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint32_t voxel = grid.voxel_of_point[i];
        EXPECT_EQ(voxel == no_voxel, i == 7 || i == 8);
        if (voxel == no_voxel) continue;
        ++counts[voxel];
        EXPECT_LT((points[i] - grid.cloud.positions[voxel]).cwiseAbs().maxCoeff(), 0.3F + 1e-5F);
    }
    EXPECT_EQ(counts, grid.num_points);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0U), points.size() - 2);
}

TEST(VoxelGrid, DoesNotDependOnTheOrder) {
    Random random(3);
    auto points = test::random_points(random, 5000, 2.0);
    const VoxelGrid expected = downsample_voxel_grid(cloud_of(points), {.voxel_size = 0.25});
    for (int run = 0; run < 5; ++run) {
        shuffle(points, random);
        const VoxelGrid grid = downsample_voxel_grid(cloud_of(points), {.voxel_size = 0.25});
        EXPECT_EQ(grid.cloud.positions, expected.cloud.positions);
        EXPECT_EQ(grid.num_points, expected.num_points);
    }
}

TEST(VoxelGrid, CellsBelowZeroAreAsWideAsOthers) {
    const VoxelGrid grid = downsample_voxel_grid(
        cloud_of({{-0.4F, 0, 0}, {-0.1F, 0, 0}, {0.1F, 0, 0}, {0.5F, 0, 0}}), {.voxel_size = 0.5});
    ASSERT_EQ(grid.cloud.size(), 3U);
    EXPECT_FLOAT_EQ(grid.cloud.positions[0].x(), -0.25F);
    EXPECT_FLOAT_EQ(grid.cloud.positions[1].x(), 0.1F);
    EXPECT_FLOAT_EQ(grid.cloud.positions[2].x(), 0.5F);
}

TEST(VoxelGrid, TakesDuplicatesAndFarPoints) {
    std::vector<Eigen::Vector3f> points(1000, Eigen::Vector3f(1.5F, 2.5F, 3.5F));
    points.emplace_back(1e30F, 0.0F, 0.0F);
    points.emplace_back(-1e12F, 0.0F, 0.0F);
    points.emplace_back(1e6F, 0.0F, 0.0F);
    const VoxelGrid grid = downsample_voxel_grid(cloud_of(points), {.voxel_size = 0.01});
    ASSERT_EQ(grid.cloud.size(), 2U);
    EXPECT_EQ(grid.cloud.positions[0], points[0]);
    EXPECT_EQ(grid.num_points[0], 1000U);
    EXPECT_EQ(grid.cloud.positions[1], points[1002]);
    EXPECT_EQ(grid.voxel_of_point[1000], no_voxel);
    EXPECT_EQ(grid.voxel_of_point[1001], no_voxel);
}

TEST(VoxelGrid, AveragesNormals) {
    PointCloud cloud =
        cloud_of({{0.1F, 0, 0}, {0.2F, 0, 0}, {0.3F, 0, 0}, {5, 0, 0}, {9, 0, 0}, {9, 0, 0}});
    cloud.normals = {{1, 0, 0}, {0, 1, 0}, {NAN, NAN, NAN}, {NAN, NAN, NAN}, {0, 0, 1}, {0, 0, -1}};
    const VoxelGrid grid = downsample_voxel_grid(cloud, {.voxel_size = 1.0});
    ASSERT_EQ(grid.cloud.normals.size(), 3U);
    EXPECT_THAT(grid.cloud.normals[0],
                test::VectorNear(Eigen::Vector3f(1, 1, 0).normalized(), 1e-6));
    // There is no direction to speak of: not a vector that would pass for a normal.
    EXPECT_FALSE(grid.cloud.normals[1].allFinite());
    EXPECT_FALSE(grid.cloud.normals[2].allFinite());
}

TEST(VoxelGrid, KeepsSensorPoseAndShift) {
    PointCloud cloud = cloud_of({{0, 0, 0}});
    cloud.intensities = {1.0F};
    cloud.sensor_pose = Transform(Eigen::Translation3d(1, 2, 3));
    cloud.global_shift = {5, 6, 7};
    const PointCloud thinned = downsample_voxel_grid(cloud).cloud;
    ASSERT_TRUE(thinned.sensor_pose);
    EXPECT_EQ(thinned.global_shift, cloud.global_shift);
    EXPECT_TRUE(thinned.intensities.empty());
    EXPECT_TRUE(thinned.normals.empty());
    EXPECT_TRUE(downsample_voxel_grid({}).cloud.empty());
    EXPECT_THROW(downsample_voxel_grid(cloud, {.voxel_size = 0.0}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
