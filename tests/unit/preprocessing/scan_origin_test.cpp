// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scan_origin.hpp"

#include <limits>
#include <optional>
#include <utility>
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

/// Both scans of a room in one map; the files of neither say where it was seen from.
ScanMap map_of(PointCloud first, PointCloud second) {
    std::vector<Scan> scans(2);
    scans[0].cloud = std::move(first);
    scans[1].cloud = std::move(second);
    Transform shifted = Transform::Identity();
    shifted.translation() = Eigen::Vector3d(8.0, 0.0, 0.0);
    const std::vector<std::optional<Transform>> poses{Transform::Identity(), shifted};
    return merge_scans(std::move(scans), poses);
}

/// Into the coordinates of a building.
PointCloud moved_scan() {
    PointCloud moved = scan_of_room();
    for (Eigen::Vector3f& point : moved.positions)
        point += Eigen::Vector3f(4.0F, 3.0F, 1.0F);
    moved.sensor_pose.reset();
    return moved;
}

PointCloud silent_scan() {
    PointCloud scan = scan_of_room();
    scan.sensor_pose.reset();
    return scan;
}

TEST(SettleAssumedScanners, TakesAwayThatOfALoneScanThatStoodElsewhere) {
    for (const bool is_moved : {true, false}) {
        std::vector<Scan> scans(1);
        scans[0].cloud = is_moved ? moved_scan() : silent_scan();
        ScanMap map =
            merge_scans(std::move(scans), std::vector{std::optional(Transform::Identity())});
        ASSERT_TRUE(map.sections[0].sensor_position);
        const auto tests = settle_assumed_scanners(map, {});
        ASSERT_EQ(tests.size(), 1U);
        EXPECT_EQ(tests[0].second.is_scanner, !is_moved) << tests[0].second.share_of_jumps;
        EXPECT_EQ(map.sections[0].sensor_position.has_value(), !is_moved);
        EXPECT_EQ(map.sections[0].sensor_axes.has_value(), !is_moved);
    }
}

/// Points all over a room, as from everywhere.
TEST(SettleAssumedScanners, TakesAwayThatOfAMapAmongScans) {
    PointCloud cloud;
    Random random(4);
    cloud.positions = test::random_points(random, 5000, 3.0);
    ScanMap map = map_of(silent_scan(), cloud);
    const auto tests = settle_assumed_scanners(map, {});
    ASSERT_EQ(tests.size(), 2U);
    EXPECT_TRUE(tests[0].second.is_scanner);
    EXPECT_FALSE(tests[1].second.is_scanner) << tests[1].second.share_of_jumps;
    EXPECT_TRUE(map.sections[0].sensor_position);
    EXPECT_FALSE(map.sections[1].sensor_position);
    EXPECT_FALSE(map.sections[1].sensor_axes);
}

TEST(SettleAssumedScanners, KeepsWhatTooFewPointsTellNothingOf) {
    PointCloud few;
    Random random(4);
    few.positions = test::random_points(random, 100, 3.0);
    ScanMap map = map_of(silent_scan(), few);
    EXPECT_EQ(settle_assumed_scanners(map, {}).size(), 1U);
    EXPECT_TRUE(map.sections[1].sensor_position);
}

TEST(SettleAssumedScanners, BelievesWhatFilesSay) {
    PointCloud moved = moved_scan();
    moved.sensor_pose = Transform::Identity();
    ScanMap map = map_of(silent_scan(), moved);
    EXPECT_EQ(settle_assumed_scanners(map, {}).size(), 1U);
    EXPECT_TRUE(map.sections[1].sensor_position);
}

TEST(SettleAssumedScanners, GivesALoneCloudItsScanner) {
    Scan scan;
    scan.cloud = silent_scan();
    ScanMap map = map_of_cloud(scan);
    ASSERT_FALSE(map.sections[0].sensor_position);
    settle_assumed_scanners(map, {});
    ASSERT_TRUE(map.sections[0].sensor_position);
    EXPECT_TRUE(map.sections[0].sensor_position->isZero());
    // Far coordinates begin nowhere.
    scan.cloud.global_shift = Eigen::Vector3d(4.0e5, 5.0e6, 0.0);
    map = map_of_cloud(scan);
    EXPECT_TRUE(settle_assumed_scanners(map, {}).empty());
    EXPECT_FALSE(map.sections[0].sensor_position);
}

}  // namespace
}  // namespace roomscribe
