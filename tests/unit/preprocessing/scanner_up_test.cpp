// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scanner_up.hpp"

#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// What a camera with a field of view of 90 degrees sees that looks along `view`.
std::vector<Vector3f> frustum(const Vector3f& view) {
    Random random(1);
    std::vector<Vector3f> points;
    while (points.size() < 500) {
        const Vector3f point = test::random_points(random, 1, 3.0)[0];
        if (point.dot(view) > 0.71F * point.norm()) points.push_back(point);
    }
    return points;
}

TEST(UsualUp, KnowsTheFramesOfCameras) {
    const UsualUp optical = usual_up(frustum(Vector3f::UnitZ()));
    EXPECT_TRUE(optical.is_camera);
    EXPECT_EQ(optical.up, Vector3d(0, -1, 0));
    const UsualUp graphics = usual_up(frustum(-Vector3f::UnitZ()));
    EXPECT_TRUE(graphics.is_camera);
    EXPECT_EQ(graphics.up, Vector3d(0, 1, 0));
    const UsualUp body = usual_up(frustum(Vector3f::UnitX()));
    EXPECT_TRUE(body.is_camera);
    EXPECT_EQ(body.up, Vector3d(0, 0, 1));
}

TEST(UsualUp, IsZOfWhatSeesMoreThanACamera) {
    std::vector<Vector3f> points = frustum(Vector3f::UnitZ());
    points.emplace_back(1.0F, 0.0F, -0.5F);
    EXPECT_FALSE(usual_up(points).is_camera);
    EXPECT_EQ(usual_up(points).up, Vector3d::UnitZ());
    EXPECT_FALSE(usual_up({}).is_camera);
}

TEST(UsualUp, DoesNotLookAtPointsThatAreNone) {
    std::vector<Vector3f> points = frustum(Vector3f::UnitZ());
    points.push_back(Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    EXPECT_TRUE(usual_up(points).is_camera);
}

Vector3d leaning(double degrees_off) {
    return Eigen::AngleAxisd(radians(degrees_off), Vector3d::UnitX()) * Vector3d::UnitZ();
}

TEST(CommonUp, IsTheMeanOfThoseThatAgree) {
    const std::vector<UsualUp> scanners{{leaning(20.0), false}, {leaning(-20.0), false}};
    EXPECT_LT((common_up(scanners) - Vector3d(0, 0, 0.2)).norm(), 1e-12);
    const std::vector<UsualUp> cameras{{leaning(20.0), true}, {leaning(-20.0), true}};
    EXPECT_LT((common_up(cameras) - Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(CommonUp, TrustsALoneScannerLittleAndThoseThatDisagreeNotAtAll) {
    EXPECT_NEAR(common_up(std::vector<UsualUp>{{leaning(10.0), false}}).norm(), 0.1, 1e-12);
    EXPECT_NEAR(common_up(std::vector<UsualUp>{{leaning(10.0), true}}).norm(), 1.0, 1e-12);
    EXPECT_TRUE(
        common_up(std::vector<UsualUp>{{leaning(0.0), true}, {leaning(90.0), true}}).isZero());
    EXPECT_TRUE(common_up({}).isZero());
}

}  // namespace
}  // namespace roomscribe
