// SPDX-License-Identifier: MIT
#include "roomscribe/structure/boundary_points.hpp"

#include <set>

#include <gtest/gtest.h>
#include <pcl/features/boundary.h>
#include <pcl/search/kdtree.h>

#include "rival_clouds.hpp"
#include "roomscribe/structure/plane_ransac.hpp"

namespace roomscribe {
namespace {

/// PCL's verdicts on the points of one plane.
std::vector<bool> boundary_of_pcl(const std::vector<Eigen::Vector3f>& points,
                                  const Eigen::Vector3d& normal, double radius) {
    pcl::BoundaryEstimation<pcl::PointXYZ, pcl::Normal, pcl::Boundary> estimation;
    estimation.setInputCloud(test::to_pcl(points));
    estimation.setInputNormals(
        test::normals_to_pcl(std::vector<Eigen::Vector3f>(points.size(), normal.cast<float>())));
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setRadiusSearch(radius);
    estimation.setAngleThreshold(static_cast<float>(M_PI_2));
    pcl::PointCloud<pcl::Boundary> boundary;
    estimation.compute(boundary);
    std::vector<bool> result;
    for (const pcl::Boundary& point : boundary)
        result.push_back(point.boundary_point != 0);
    return result;
}

TEST(BoundaryPointsAgainstPcl, VerdictsAgree) {
    for (const test::Input& input : test::inputs(0.05)) {
        SCOPED_TRACE(input.name);
        constexpr double radius = 0.15;
        PointCloud cloud;
        cloud.positions = input.positions;
        const auto planes = detect_planes_ransac(
            cloud, 1,
            {.detection = {.distance_tolerance = 0.02, .min_inliers = 100, .max_planes = 1},
             .consensus = {}});
        ASSERT_EQ(planes.planes.size(), 1U);
        const PlanarPatch& patch = planes.planes[0];
        // PCL looks for neighbours in space; on the plane itself that is the same.
        std::vector<Eigen::Vector3f> flat;
        std::vector<std::uint32_t> all;
        for (const std::uint32_t point : patch.points) {
            all.push_back(static_cast<std::uint32_t>(flat.size()));
            flat.push_back(
                patch.plane.project(input.positions[point].cast<double>()).cast<float>());
        }
        const auto ours = find_boundary_points(flat, all, patch.plane, {.radius = radius});
        const std::set<std::uint32_t> set(ours.begin(), ours.end());
        const std::vector<bool> theirs = boundary_of_pcl(flat, patch.plane.normal, radius);
        ASSERT_EQ(theirs.size(), flat.size());
        std::size_t num_alike = 0;
        for (std::size_t i = 0; i < flat.size(); ++i)
            num_alike += theirs[i] == (set.count(static_cast<std::uint32_t>(i)) == 1) ? 1 : 0;
        // What differs lies at the very radius, or has gaps of the very angle.
        EXPECT_GE(static_cast<double>(num_alike), 0.99 * static_cast<double>(flat.size()));
    }
}

}  // namespace
}  // namespace roomscribe
