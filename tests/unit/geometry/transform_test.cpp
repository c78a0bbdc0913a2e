// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/transform.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using std::numbers::pi;

TEST(RotationAngle, IsAccurateFromZeroToPi) {
    Random random(1);
    for (const double angle : {0.0, 1e-12, 1e-8, 1e-3, 1.0, 2.0, 3.1, pi - 1e-3, pi - 1e-8, pi}) {
        for (int i = 0; i < 50; ++i) {
            const Eigen::AngleAxisd turn(angle, test::random_direction(random));
            // Near 0 the entries' own rounding, 1e-16, is all that is lost.
            EXPECT_NEAR(rotation_angle(turn.toRotationMatrix()), angle, 1e-15 + 1e-14 * angle);
        }
    }
}

TEST(NearestRotation, KeepsRotationsAndMendsDrift) {
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const Eigen::Matrix3d rotation = test::random_transform(random).linear();
        EXPECT_TRUE(nearest_rotation(rotation).isApprox(rotation, 1e-12));
        // A symmetric positive factor is what the polar decomposition takes away.
        const Eigen::Matrix3d drift =
            Eigen::Matrix3d::NullaryExpr([&random] { return random.uniform(-1e-2, 1e-2); });
        const Eigen::Matrix3d stretch =
            Eigen::Matrix3d::Identity() + 0.5 * (drift + drift.transpose());
        EXPECT_TRUE(nearest_rotation(rotation * stretch).isApprox(rotation, 1e-12));
        EXPECT_NEAR(nearest_rotation(-rotation).determinant(), 1.0, 1e-12);
    }
}

TEST(NearestRotation, OfAReflectionIsNearestAmongRotations) {
    const Eigen::Matrix3d reflection = Eigen::Vector3d(3.0, 2.0, -1.0).asDiagonal();
    EXPECT_TRUE(nearest_rotation(reflection).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
}

TEST(PointSpread, OfAKnownShape) {
    const std::vector<Eigen::Vector3f> points = {{1, 2, 0}, {3, 2, 0}, {2, 2, 3}, {2, 2, -3}};
    const PointSpread spread = measure_spread(points);
    EXPECT_THAT(spread.mean, test::VectorNear(Eigen::Vector3d(2, 2, 0), 1e-12));
    const Eigen::Matrix3d expected = Eigen::Vector3d(0.5, 0.0, 4.5).asDiagonal();
    EXPECT_TRUE(spread.covariance.isApprox(expected, 1e-12));
    EXPECT_EQ(measure_spread({}).mean, Eigen::Vector3d::Zero());
}

TEST(RmsDisplacement, AgreesWithBruteForce) {
    Random random(3);
    for (int run = 0; run < 50; ++run) {
        const auto points = test::random_points(random, 40, 3.0);
        const Transform a = test::random_transform(random, 4.0);
        const Transform b = run % 2 == 0 ? test::random_transform(random, 4.0)
                                         : a * test::small_transform(random, 1e-3, 1e-3);
        double sum = 0.0;
        for (const Eigen::Vector3f& point : points) {
            sum += (a * point.cast<double>() - b * point.cast<double>()).squaredNorm();
        }
        const double expected = std::sqrt(sum / static_cast<double>(points.size()));
        EXPECT_NEAR(rms_displacement(measure_spread(points), a, b), expected, 1e-9 * expected);
        EXPECT_EQ(rms_displacement(measure_spread(points), a, a), 0.0);
    }
}

TEST(TransformFromTwist, IsTheExponentialMapOfTheTurn) {
    Eigen::Matrix<double, 6, 1> twist;
    twist << 0.0, 0.0, pi / 2.0, 1.0, 2.0, 3.0;
    EXPECT_THAT(transform_from_twist(twist) * Eigen::Vector3d(1, 0, 0),
                test::VectorNear(Eigen::Vector3d(1, 3, 3), 1e-12));
    twist.head<3>().setZero();
    EXPECT_EQ(transform_from_twist(twist).linear(), Eigen::Matrix3d::Identity());
    twist.head<3>() << 1e-9, -2e-9, 2e-9;
    EXPECT_NEAR(rotation_angle(transform_from_twist(twist).linear()), 3e-9, 1e-15);
}

}  // namespace
}  // namespace roomscribe
