// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/free_space.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"
#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr double half_size = 2.0;

/// A closed cube of edge 4, seen from `sensor` inside it.
std::vector<Eigen::Vector3f> scan_cube(Random& random, const Vector3d& sensor, int count) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < count; ++i) {
        const Vector3d direction = test::random_direction(random);
        double length = INFINITY;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const double wall = direction[axis] > 0.0 ? half_size : -half_size;
            length = std::min(length, (wall - sensor[axis]) / direction[axis]);
        }
        points.emplace_back((sensor + length * direction).cast<float>());
    }
    return points;
}

/// The same cube from its middle by a spinning scanner: rings far apart, dense along each.
std::vector<Eigen::Vector3f> scan_cube_in_rings(double step_of_rings) {
    std::vector<Eigen::Vector3f> points;
    for (double elevation = radians(-44.0); elevation < radians(44.0); elevation += step_of_rings) {
        for (double azimuth = 0.0; azimuth < 2.0 * std::numbers::pi; azimuth += radians(0.2)) {
            const Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
            points.emplace_back(
                (direction * (half_size / direction.cwiseAbs().maxCoeff())).cast<float>());
        }
    }
    return points;
}

TEST(FreeSpace, BetweenTheRingsOfASpinningScanner) {
    Random random(2);
    // 64, 32 and 16 rings over such a field of view.
    for (const double step : {1.4, 2.9, 5.5}) {
        const FreeSpace space(scan_cube_in_rings(radians(step)), Vector3d::Zero(), 2.5);
        int num_free = 0;
        constexpr int count = 1000;
        for (int i = 0; i < count; ++i) {
            const Vector3d place(random.uniform(0.8, 1.5), random.uniform(-0.6, 0.6),
                                 random.uniform(-0.6, 0.6));
            num_free += space.look_at(place, 0.1) == Visibility::free ? 1 : 0;
            EXPECT_NE(space.look_at(2.0 * place / place.x(), 0.1), Visibility::free);
        }
        EXPECT_GT(num_free, 0.9 * count) << step << " degrees";
    }
}

TEST(FreeSpace, OfAClosedRoom) {
    Random random(1);
    for (const Vector3d& sensor : {Vector3d(0, 0, 0), Vector3d(1.0, -0.6, 0.4)}) {
        const FreeSpace space(scan_cube(random, sensor, 60'000), sensor);
        int num_free = 0;
        int num_hidden = 0;
        int num_on_surface = 0;
        constexpr int count = 1000;
        for (int i = 0; i < count; ++i) {
            const Vector3d place(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5),
                                 random.uniform(-1.5, 1.5));
            const Visibility inside = space.look_at(place, 0.1);
            EXPECT_TRUE(inside == Visibility::free || inside == Visibility::unseen);
            if (inside == Visibility::free) ++num_free;
            const Vector3d wall = place * (half_size / place.cwiseAbs().maxCoeff());
            const Visibility on_wall = space.look_at(wall, 0.1);
            EXPECT_TRUE(on_wall == Visibility::surface || on_wall == Visibility::unseen);
            if (on_wall == Visibility::surface) ++num_on_surface;
            const Visibility behind = space.look_at(2.0 * wall, 0.1);
            EXPECT_TRUE(behind == Visibility::hidden || behind == Visibility::unseen);
            if (behind == Visibility::hidden) ++num_hidden;
        }
        // All but the few at the corners of the cube map.
        EXPECT_GT(num_free, 0.95 * count);
        EXPECT_GT(num_on_surface, 0.95 * count);
        EXPECT_GT(num_hidden, 0.95 * count);
    }
}

TEST(FreeSpace, KnowsNothingWhereNoRayWent) {
    Random random(2);
    auto points = scan_cube(random, Vector3d::Zero(), 30'000);
    for (Eigen::Vector3f& point : points) {
        if (point.x() > 0.0F) point.setConstant(NAN);
    }
    const FreeSpace space(points, Vector3d::Zero());
    EXPECT_EQ(space.look_at({1.0, 0.2, 0.1}, 0.1), Visibility::unseen);
    EXPECT_EQ(space.look_at({-1.0, 0.2, 0.1}, 0.1), Visibility::free);
    EXPECT_EQ(space.look_at({0.0, 0.0, 0.0}, 0.1), Visibility::unseen);
}

TEST(FreeSpace, OfNothingIsUnseen) {
    const std::vector<Eigen::Vector3f> nan(100, Eigen::Vector3f(NAN, NAN, NAN));
    for (const FreeSpace& space : {FreeSpace({}, {0, 0, 0}), FreeSpace(nan, {0, 0, 0})}) {
        EXPECT_EQ(space.look_at({1.0, 0.2, 0.1}, 0.1), Visibility::unseen);
    }
    EXPECT_EQ(self_contradiction({}, {0, 0, 0}, 0.1), 0.0);
}

TEST(FreeSpace, MarginMovesTheBorders) {
    Random random(3);
    const FreeSpace space(scan_cube(random, Vector3d::Zero(), 60'000), Vector3d::Zero());
    const Vector3d place(1.7, 0.2, -0.1);
    EXPECT_EQ(space.look_at(place, 0.1), Visibility::free);
    EXPECT_EQ(space.look_at(place, 0.5), Visibility::surface);
}

TEST(SelfContradiction, IsSmallForOneScanAndLargeForAMergedCloud) {
    Random random(4);
    const Vector3d place(5.0, 1.0, 1.4);
    const Scan scan =
        test::simulate_scan(test::l_shaped_room(), Transform(Eigen::Translation3d(place)), 1);
    const double honest = self_contradiction(scan.cloud.positions, Vector3d::Zero(), 0.05);
    EXPECT_LT(honest, 0.1);

    // What a position round the corner saw, in the first one's frame.
    const Vector3d shift(-3.8, 3.2, 0.0);
    const Scan other = test::simulate_scan(test::l_shaped_room(),
                                           Transform(Eigen::Translation3d(place + shift)), 2);
    auto merged = scan.cloud.positions;
    for (const Eigen::Vector3f& point : other.cloud.positions) {
        merged.push_back(point + shift.cast<float>());
    }
    EXPECT_GT(self_contradiction(merged, Vector3d::Zero(), 0.05), 2.0 * honest + 0.05);
}

}  // namespace
}  // namespace roomscribe
