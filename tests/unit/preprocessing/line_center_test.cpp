// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/line_center.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Where a ray from within the box of 5 x 4 x 3 m about the origin meets it.
Vector3d hit_box(const Vector3d& origin, const Vector3d& direction) {
    const Vector3d half(2.5, 2.0, 1.5);
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) continue;
        const double side = direction[axis] > 0.0 ? half[axis] : -half[axis];
        nearest = std::min(nearest, (side - origin[axis]) / direction[axis]);
    }
    return origin + nearest * direction;
}

/// A planar laser that nods about an axis through `center`, `arm` before it, in millimetres; one
/// ray in 20 without return, of which every second is zero.
Scan nodding_scan(const Vector3d& center, double arm, std::uint64_t seed) {
    constexpr std::size_t num_lines = 60;
    constexpr std::size_t num_rays = 181;
    Random random(seed);
    Scan scan;
    scan.cloud.grid = ScanGrid{num_lines, num_rays};
    for (std::size_t line = 0; line < num_lines; ++line) {
        const double tilt = radians(-40.0 + static_cast<double>(line));
        const Eigen::AngleAxisd turn(tilt, Vector3d::UnitY());
        const Vector3d origin = center + arm * (turn * Vector3d::UnitX());
        for (std::size_t ray = 0; ray < num_rays; ++ray) {
            const double angle = radians(-90.0 + static_cast<double>(ray));
            const Vector3d direction = turn * Vector3d(std::cos(angle), std::sin(angle), 0.0);
            const double noise = random.normal() * 0.01;
            const Vector3d point = hit_box(origin, direction) + noise * direction;
            Eigen::Vector3f written = ((point * 1000.0).array().round() / 1000.0).cast<float>();
            if (random.below(20) == 0)
                written.setConstant(ray % 2 == 0 ? 0.0F : std::numeric_limits<float>::quiet_NaN());
            scan.cloud.positions.push_back(written);
        }
    }
    return scan;
}

TEST(LineCenter, IsWhereALaserNodded) {
    for (const Vector3d& center : {Vector3d(0.0, 0.0, 0.0), Vector3d(0.1, -0.7, 0.6)}) {
        const auto found = find_line_center(nodding_scan(center, 0.0, 1).cloud);
        ASSERT_TRUE(found);
        EXPECT_LT((*found - center).norm(), 0.01) << found->transpose();
    }
}

TEST(LineCenter, IsInTheMiddleOfTheWayOfALaserBesideItsAxis) {
    const Vector3d center(0.2, 0.1, -0.3);
    const auto found = find_line_center(nodding_scan(center, 0.07, 2).cloud);
    ASSERT_TRUE(found);
    EXPECT_NEAR((*found - center).norm(), 0.07, 0.02);
    EXPECT_GT(found->x(), center.x());
}

TEST(LineCenter, MovesWithTheCloud) {
    const Vector3d center(0.1, -0.7, 0.6);
    Scan scan = nodding_scan(center, 0.0, 3);
    Random random(4);
    const Transform motion = test::random_transform(random);
    // What is not a return stays none.
    for (Eigen::Vector3f& point : scan.cloud.positions) {
        if (!point.isZero(0.0F)) point = (motion * point.cast<double>()).cast<float>();
    }
    const auto found = find_line_center(scan.cloud);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - motion * center).norm(), 0.01);
}

TEST(LineCenter, IsTheSameWhetherLinesAreRowsOrColumns) {
    const Vector3d center(0.1, -0.7, 0.6);
    const Scan scan = nodding_scan(center, 0.0, 5);
    Scan turned;
    turned.cloud.grid = ScanGrid{scan.cloud.grid->columns, scan.cloud.grid->rows};
    for (std::size_t column = 0; column < scan.cloud.grid->columns; ++column) {
        for (std::size_t row = 0; row < scan.cloud.grid->rows; ++row)
            turned.cloud.positions.push_back(
                scan.cloud.positions[row * scan.cloud.grid->columns + column]);
    }
    const auto found = find_line_center(turned.cloud);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - center).norm(), 0.01);
}

TEST(LineCenter, IsNotToldByWhatIsNoScan) {
    EXPECT_FALSE(find_line_center({}));
    Scan unordered = nodding_scan(Vector3d::Zero(), 0.0, 6);
    unordered.cloud.grid.reset();
    EXPECT_FALSE(find_line_center(unordered.cloud));
    // A grid of heights: its rows lie in parallel planes.
    Scan heights;
    heights.cloud.grid = ScanGrid{60, 60};
    // A grid whose points are anywhere.
    Scan anywhere = heights;
    Random random(7);
    for (int row = 0; row < 60; ++row) {
        for (int column = 0; column < 60; ++column) {
            heights.cloud.positions.emplace_back(0.1F * static_cast<float>(column),
                                                 0.1F * static_cast<float>(row),
                                                 static_cast<float>(random.uniform()));
        }
    }
    anywhere.cloud.positions = test::random_points(random, 3600, 2.0);
    EXPECT_FALSE(find_line_center(heights.cloud));
    EXPECT_FALSE(find_line_center(anywhere.cloud));
}

TEST(LineCenter, BecomesTheSensorPoseOfAScanThatHasNone) {
    Scan scan = nodding_scan(Vector3d(0.1, -0.7, 0.6), 0.0, 8);
    ASSERT_TRUE(locate_scanner(scan));
    EXPECT_LT((scan.sensor_position() - Vector3d(0.1, -0.7, 0.6)).norm(), 0.01);
    EXPECT_TRUE(scan.sensor_axes().isIdentity());
    const Transform before = *scan.cloud.sensor_pose;
    EXPECT_FALSE(locate_scanner(scan));
    EXPECT_TRUE(scan.cloud.sensor_pose->isApprox(before));
}

}  // namespace
}  // namespace roomscribe
