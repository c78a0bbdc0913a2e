// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/axes_error.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

Transform turn(double angle, const Eigen::Vector3d& axis) {
    return Transform(Eigen::AngleAxisd(radians(angle), axis));
}

TEST(AxesError, OfTurnsAboutUpAreHorizontalModuloAQuarter) {
    Random random(1);
    for (const auto& [angle, expected] : std::vector<std::pair<double, double>>{{0, 0},
                                                                                {3, 3},
                                                                                {-3, 3},
                                                                                {90, 0},
                                                                                {87, 3},
                                                                                {-178, 2},
                                                                                {45, 45},
                                                                                {135, 45},
                                                                                {200, 20}}) {
        const Transform room_from_map = test::random_transform(random);
        const AxesError error =
            compare_axes(room_from_map, turn(angle, Eigen::Vector3d::UnitZ()) * room_from_map);
        EXPECT_NEAR(degrees(error.up), 0.0, 1e-6);
        EXPECT_NEAR(degrees(error.horizontal), expected, 1e-6) << angle;
    }
}

TEST(AxesError, OfTiltsAreOfUp) {
    Random random(2);
    const Transform room_from_map = test::random_transform(random);
    for (const double angle : {0.5, 10.0, 90.0, 180.0}) {
        for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
            const AxesError error = compare_axes(room_from_map, turn(angle, axis) * room_from_map);
            EXPECT_NEAR(degrees(error.up), angle, 1e-6);
            EXPECT_NEAR(degrees(error.horizontal), 0.0, 1e-6);
        }
    }
}

TEST(AxesError, DoesNotDependOnWhereTheRoomIs) {
    const Transform moved = Eigen::Translation3d(5, 6, 7) * turn(4, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(degrees(compare_axes(Transform::Identity(), moved).horizontal), 4.0, 1e-9);
}

}  // namespace
}  // namespace roomscribe
