// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/icp.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <pcl/registration/icp.h>

#include "rival_clouds.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Root mean square distance of the moved source points to their nearest target points.
double error_of(const test::Input& source, const test::Input& target, const Transform& pose) {
    double sum = 0.0;
    for (const Eigen::Vector3f& point : source.positions) {
        const Eigen::Vector3d moved = pose * point.cast<double>();
        sum += target.tree.nearest(moved.cast<float>()).squared_distance;
    }
    return std::sqrt(sum / static_cast<double>(source.positions.size()));
}

/// Both align the same points by equation (1) from the same guess. Every point has its partner, so
/// that both minimise the same number.
TEST(IcpAgainstPcl, EndsWithNoLargerError) {
    Random random(1);
    for (const test::Input& target : test::inputs(0.1)) {
        SCOPED_TRACE(target.name);
        PointCloud moved;
        moved.positions =
            test::transformed(target.positions, test::small_transform(random, radians(5.0), 0.15));
        test::add_noise(moved.positions, 0.01, random);
        const test::Input source("moved", moved, 0.12);

        pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> rival;
        rival.setInputSource(test::to_pcl(source.positions));
        rival.setInputTarget(test::to_pcl(target.positions));
        rival.setMaxCorrespondenceDistance(10.0);
        rival.setMaximumIterations(100);
        rival.setTransformationEpsilon(1e-10);
        pcl::PointCloud<pcl::PointXYZ> aligned;
        rival.align(aligned);
        const Transform theirs(rival.getFinalTransformation().cast<double>());

        const IcpResult ours = align_icp(
            {source.positions, {}}, {target.positions, {}, target.tree}, Transform::Identity(),
            {.method = IcpMethod::point_to_point, .max_correspondence_distance = 10.0});
        EXPECT_LE(error_of(source, target, ours.target_from_source),
                  1.001 * error_of(source, target, theirs));
    }
}

}  // namespace
}  // namespace roomscribe
