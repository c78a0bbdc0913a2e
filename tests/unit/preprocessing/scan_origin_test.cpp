// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scan_origin.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

/// A furnished room seen from its origin.
PointCloud scan_of_room() {
    Transform room_from_scan = Transform::Identity();
    room_from_scan.translation() = Eigen::Vector3d(3.0, 1.5, 1.4);
    return test::simulate_scan(test::l_shaped_room(), room_from_scan, 3).cloud;
}

TEST(ScanOrigin, KnowsAScanHoweverItIsTurned) {
    const PointCloud scan = scan_of_room();
    EXPECT_TRUE(test_scan_origin(scan).is_scanner);
    Random random(5);
    PointCloud turned = scan;
    turned.positions = test::transformed(scan.positions, test::random_transform(random, 0.0));
    EXPECT_TRUE(test_scan_origin(turned).is_scanner);
}

TEST(ScanOrigin, SaysNoToAScanThatWasMoved) {
    PointCloud moved = scan_of_room();
    for (Eigen::Vector3f& point : moved.positions)
        point += Eigen::Vector3f(1.2F, 0.4F, -0.3F);
    const OriginTest test = test_scan_origin(moved);
    EXPECT_FALSE(test.is_scanner) << test.share_of_jumps;
}

TEST(ScanOrigin, SaysNoToSeveralScansInOneCloud) {
    PointCloud map = scan_of_room();
    Transform second = Transform::Identity();
    second.translation() = Eigen::Vector3d(1.2, 3.8, 1.2);
    PointCloud other = test::simulate_scan(test::l_shaped_room(), second, 4).cloud;
    Transform first_from_second = Transform::Identity();
    first_from_second.translation() = second.translation() - Eigen::Vector3d(3.0, 1.5, 1.4);
    other.positions = test::transformed(other.positions, first_from_second);
    map.positions.insert(map.positions.end(), other.positions.begin(), other.positions.end());
    EXPECT_FALSE(test_scan_origin(map).is_scanner);
}

TEST(ScanOrigin, SaysNoToNothing) {
    EXPECT_FALSE(test_scan_origin({}).is_scanner);
    PointCloud lost;
    lost.positions.assign(5000, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    EXPECT_FALSE(test_scan_origin(lost).is_scanner);
}

}  // namespace
}  // namespace roomscribe
