// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/search/kdtree.h>

#include "rival_clouds.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// PCL's cells are multiples of the leaf size too, so that both make the same cells.
TEST(VoxelGridAgainstPcl, HasTheSameCentroids) {
    for (const PointCloud& cloud : test::raw_clouds()) {
        for (const double size : {0.05, 0.2}) {
            pcl::VoxelGrid<pcl::PointXYZ> filter;
            filter.setInputCloud(test::to_pcl(cloud.positions));
            filter.setLeafSize(static_cast<float>(size), static_cast<float>(size),
                               static_cast<float>(size));
            pcl::PointCloud<pcl::PointXYZ> theirs;
            filter.filter(theirs);
            std::vector<Eigen::Vector3f> their_points;
            for (const pcl::PointXYZ& point : theirs) {
                their_points.push_back(point.getVector3fMap());
            }
            const auto ours = downsample_voxel_grid(cloud, {.voxel_size = size}).cloud.positions;

            // They decide in float32 in which cell a point lies; on a border it may be the other.
            const double count = static_cast<double>(ours.size());
            EXPECT_NEAR(static_cast<double>(their_points.size()), count, 1e-3 * count);
            const SearchTree tree(their_points);
            const auto num_same = std::count_if(ours.begin(), ours.end(), [&](const auto& point) {
                return tree.nearest(point).squared_distance < 1e-10F;
            });
            EXPECT_GT(static_cast<double>(num_same), 0.99 * count);
        }
    }
}

TEST(NormalsAgainstPcl, AgreeToATenthOfADegree) {
    for (const test::Input& input : test::inputs(0.04)) {
        SCOPED_TRACE(input.name);
        constexpr int num_neighbors = 20;
        pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
        estimation.setInputCloud(test::to_pcl(input.positions));
        estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
        estimation.setKSearch(num_neighbors);
        estimation.setViewPoint(0.0F, 0.0F, 0.0F);
        pcl::PointCloud<pcl::Normal> theirs;
        estimation.compute(theirs);

        const auto ours = estimate_normals(input.positions, input.tree, Eigen::Vector3d::Zero(),
                                           {.num_neighbors = num_neighbors});
        std::size_t num_compared = 0;
        std::size_t num_different = 0;
        for (std::size_t i = 0; i < input.positions.size(); ++i) {
            const Eigen::Vector3d a = ours.normals[i].cast<double>();
            const Eigen::Vector3d b = theirs[i].getNormalVector3fMap().cast<double>();
            if (!a.allFinite() || !b.allFinite()) continue;
            ++num_compared;
            // Their float32 sums lose the normal where two variances are near each other, and the
            // sign where the surface is seen edge-on.
            if (std::atan2(a.cross(b).norm(), a.dot(b)) > radians(0.1)) ++num_different;
        }
        EXPECT_EQ(num_compared, input.positions.size());
        EXPECT_LT(static_cast<double>(num_different), 0.005 * static_cast<double>(num_compared));
    }
}

}  // namespace
}  // namespace roomscribe
