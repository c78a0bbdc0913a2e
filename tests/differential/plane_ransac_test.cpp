// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_ransac.hpp"

#include <gtest/gtest.h>
#include <pcl/ModelCoefficients.h>
#include <pcl/segmentation/sac_segmentation.h>

#include "rival_clouds.hpp"

namespace roomscribe {
namespace {

/// The largest plane of a room has to hold about as many points as PCL's. RANSAC is a draw: the
/// mean over several seeds counts.
TEST(PlaneRansacAgainstPcl, LargestPlaneHoldsNoFewerPoints) {
    for (const test::Input& input : test::inputs(0.05)) {
        SCOPED_TRACE(input.name);
        constexpr double tolerance = 0.03;
        pcl::SACSegmentation<pcl::PointXYZ> rival;
        rival.setModelType(pcl::SACMODEL_PLANE);
        rival.setMethodType(pcl::SAC_RANSAC);
        rival.setOptimizeCoefficients(true);
        rival.setDistanceThreshold(tolerance);
        rival.setMaxIterations(1000);
        rival.setInputCloud(test::to_pcl(input.positions));
        pcl::PointIndices inliers;
        pcl::ModelCoefficients coefficients;
        rival.segment(inliers, coefficients);

        PointCloud cloud;
        cloud.positions = input.positions;
        double num_points = 0.0;
        constexpr int num_seeds = 5;
        for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
            const auto result = detect_planes_ransac(cloud, seed,
                                                     {.detection = {.distance_tolerance = tolerance,
                                                                    .min_inliers = 100,
                                                                    .max_planes = 1},
                                                      .consensus = {}});
            ASSERT_EQ(result.planes.size(), 1U);
            num_points += static_cast<double>(result.planes[0].points.size()) / num_seeds;
        }
        EXPECT_GE(num_points, 0.98 * static_cast<double>(inliers.indices.size()));
    }
}

}  // namespace
}  // namespace roomscribe
