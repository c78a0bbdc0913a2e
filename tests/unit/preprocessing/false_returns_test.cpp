// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/false_returns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/preprocessing/saturated_returns.hpp"
#include "roomscribe/preprocessing/stray_returns.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

/// A hall of 12 x 8 x 3 m from its middle, seen in so many random directions. Where no light comes
/// back, in `share_lost` of the directions, the scanner writes `max_range`.
Scan scan_of_hall(double share_lost, double max_range, const Eigen::Vector3d& sensor) {
    Random random(1);
    Scan scan;
    for (int i = 0; i < 20'000; ++i) {
        const Eigen::Vector3d direction = test::random_direction(random);
        const Eigen::Vector3d to_wall =
            Eigen::Vector3d(6.0, 4.0, 1.5).cwiseQuotient(direction.cwiseAbs());
        const bool is_lost = random.uniform() < share_lost;
        const double range = is_lost ? max_range : to_wall.minCoeff() + 0.01 * random.normal();
        scan.cloud.positions.emplace_back((sensor + range * direction).cast<float>());
    }
    Transform pose = Transform::Identity();
    pose.translation() = sensor;
    scan.cloud.sensor_pose = pose;
    return scan;
}

TEST(SaturatedReturns, AreFoundWhereverTheSensorStands) {
    for (const Eigen::Vector3d& sensor : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(40, -7, 3)}) {
        const Scan scan = scan_of_hall(0.03, 32.767, sensor);
        const std::vector<std::uint32_t> found =
            find_saturated_returns(scan.cloud.positions, sensor);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < scan.cloud.positions.size(); ++i) {
            if ((scan.cloud.positions[i].cast<double>() - sensor).norm() > 20.0)
                expected.push_back(i);
        }
        ASSERT_GT(expected.size(), 400U);
        EXPECT_EQ(found, expected);
        const auto rest = without_false_returns(scan);
        ASSERT_TRUE(rest.has_value());
        EXPECT_EQ(rest->cloud.positions.size(), scan.cloud.positions.size());
        for (const std::uint32_t i : found)
            EXPECT_FALSE(rest->cloud.positions[i].allFinite());
    }
}

TEST(SaturatedReturns, AHallHasNone) {
    EXPECT_FALSE(
        without_false_returns(scan_of_hall(0.0, 30.0, Eigen::Vector3d::Zero())).has_value());
}

TEST(SaturatedReturns, AFarPlaneSeenThroughADoorIsNone) {
    // Its ranges differ by less than a shell: only that it lies in one direction tells.
    Scan scan = scan_of_hall(0.0, 30.0, Eigen::Vector3d::Zero());
    Random random(2);
    for (int i = 0; i < 500; ++i) {
        scan.cloud.positions.emplace_back(
            Eigen::Vector3d(20.0, random.uniform() - 0.5, random.uniform() - 0.5).cast<float>());
    }
    EXPECT_TRUE(find_saturated_returns(scan.cloud.positions, Eigen::Vector3d::Zero()).empty());
}

TEST(SaturatedReturns, TheInsideOfADomeIsNone) {
    const Scan dome = scan_of_hall(1.0, 5.0, Eigen::Vector3d::Zero());
    EXPECT_TRUE(find_saturated_returns(dome.cloud.positions, Eigen::Vector3d::Zero()).empty());
}

TEST(SaturatedReturns, NothingOfNothing) {
    EXPECT_TRUE(find_saturated_returns({}, Eigen::Vector3d::Zero()).empty());
}

TEST(SaturatedReturns, AreTakenOutOfAMapScannerByScanner) {
    const Eigen::Vector3d sensor(4.0, -7.0, 1.0);
    const Scan lossy = scan_of_hall(0.03, 32.767, sensor);
    const auto count = static_cast<std::uint32_t>(lossy.cloud.size());
    ScanMap map;
    map.cloud.positions = lossy.cloud.positions;
    map.cloud.positions.insert(map.cloud.positions.end(), lossy.cloud.positions.begin(),
                               lossy.cloud.positions.end());
    map.sections = {{"known", 0, count, sensor}, {"unknown", count, count, std::nullopt}};
    const ScanMap whole = map;
    const std::vector<HiddenPoint> hidden = hide_false_returns(map);
    const std::vector<std::uint32_t> expected =
        find_saturated_returns(lossy.cloud.positions, sensor);
    std::size_t lost = 0;
    for (const Eigen::Vector3f& position : map.cloud.positions)
        lost += position.allFinite() ? 0 : 1;
    EXPECT_EQ(lost, expected.size());
    EXPECT_EQ(hidden.size(), expected.size());
    EXPECT_FALSE(map.cloud.positions[expected.front()].allFinite());
    put_back(hidden, map);
    EXPECT_EQ(map.cloud.positions, whole.cloud.positions);
    map.sections[0].sensor_position.reset();
    EXPECT_TRUE(hide_false_returns(map).empty());
}

/// Puts every n-th return anywhere in a box of 60 x 60 x 20 m around the hall.
void scatter(Scan& scan, std::size_t n) {
    Random random(5);
    const Eigen::Vector3d sensor = scan.sensor_position();
    for (std::size_t i = 0; i < scan.cloud.size(); i += n) {
        const Eigen::Vector3d offset(random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0),
                                     random.uniform(-10.0, 10.0));
        scan.cloud.positions[i] = (sensor + offset).cast<float>();
    }
}

TEST(StrayReturns, AreFoundAndSurfaceIsKept) {
    const Eigen::Vector3d sensor(40.0, -7.0, 3.0);
    for (const std::size_t n : {20U, 5U}) {
        Scan scan = scan_of_hall(0.0, 30.0, sensor);
        scatter(scan, n);
        const std::vector<std::uint32_t> found = find_stray_returns(scan.cloud.positions, sensor);
        const auto num_true =
            std::count_if(found.begin(), found.end(), [n](std::uint32_t i) { return i % n == 0; });
        EXPECT_GT(static_cast<double>(num_true), 0.9 * 20'000.0 / static_cast<double>(n)) << n;
        EXPECT_LT(static_cast<double>(found.size()) - static_cast<double>(num_true), 0.05 * 20'000)
            << n;
        const auto rest = without_false_returns(scan);
        ASSERT_TRUE(rest.has_value());
        for (const std::uint32_t i : found)
            EXPECT_FALSE(rest->cloud.positions[i].allFinite());
    }
}

TEST(StrayReturns, AreFoundInScansOfWhichASampleIsLookedAt) {
    const Eigen::Vector3d sensor(0.0, 0.0, 0.0);
    Scan scan = scan_of_hall(0.0, 30.0, sensor);
    // Twenty returns for each: hair-thin noise along the ray.
    const std::vector<Eigen::Vector3f> once = scan.cloud.positions;
    Random random(6);
    for (int k = 0; k < 19; ++k) {
        for (const Eigen::Vector3f& position : once)
            scan.cloud.positions.push_back(position +
                                           test::random_direction(random).cast<float>() * 0.02F);
    }
    EXPECT_TRUE(find_stray_returns(scan.cloud.positions, sensor).empty());
    scatter(scan, 10);
    const std::vector<std::uint32_t> found = find_stray_returns(scan.cloud.positions, sensor);
    const auto num_true =
        std::count_if(found.begin(), found.end(), [](std::uint32_t i) { return i % 10 == 0; });
    EXPECT_GT(num_true, 36'000);
    // At the rims, and where rays graze.
    EXPECT_LT(found.size() - static_cast<std::size_t>(num_true), 36'000U);
}

TEST(StrayReturns, AFewAreNone) {
    const Eigen::Vector3d sensor(0.0, 0.0, 0.0);
    Scan scan = scan_of_hall(0.0, 30.0, sensor);
    scatter(scan, 200);
    EXPECT_TRUE(find_stray_returns(scan.cloud.positions, sensor).empty());
    EXPECT_TRUE(find_stray_returns({}, sensor).empty());
    EXPECT_TRUE(find_stray_returns(std::span(scan.cloud.positions).first(3), sensor).empty());
}

}  // namespace
}  // namespace roomscribe
