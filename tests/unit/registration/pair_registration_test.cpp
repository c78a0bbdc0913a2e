// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pair_registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using test::TransformNear;

constexpr double coarseness = 3.0;

PreparedScan prepare(const Scan& scan) {
    return prepare_scan(
        scan, {.coarse_voxel = 0.08, .fine_voxel = 0.03, .fpfh_radius = 0.4, .noise = 0.002});
}

Scan scan_from(const Vector3d& place, std::uint64_t seed) {
    Transform pose = Transform::Identity();
    pose.translation() = place;
    return test::simulate_scan(test::l_shaped_room(), pose, seed, coarseness);
}

/// The same scan in another frame.
Scan moved(Scan scan, const Transform& motion) {
    for (Eigen::Vector3f& point : scan.cloud.positions)
        point = (motion * point.cast<double>()).cast<float>();
    Transform sensor = Transform::Identity();
    sensor.translation() = motion * scan.sensor_position();
    scan.cloud.sensor_pose = sensor;
    return scan;
}

/// The points alone, in an order that says nothing of the scanner's.
Scan shuffled(const Scan& scan, std::uint64_t seed) {
    std::vector<std::size_t> order(scan.cloud.positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random random(seed);
    for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[random.next() % i]);
    Scan result;
    result.cloud.sensor_pose = scan.cloud.sensor_pose;
    for (const std::size_t i : order)
        result.cloud.positions.push_back(scan.cloud.positions[i]);
    return result;
}

/// The same place with two people in it, each time elsewhere.
Scan scan_with_people(const Vector3d& place, std::uint64_t seed,
                      const std::array<Eigen::Vector2d, 2>& people) {
    Scenario room = test::l_shaped_room();
    for (const Eigen::Vector2d& at : people)
        room.items.push_back({.kind = "person", .at = at, .size = {0.34, 0.5, 1.75}});
    Transform pose = Transform::Identity();
    pose.translation() = place;
    return test::simulate_scan(room, pose, seed, coarseness);
}

class RegisterPairOfScans : public testing::Test {
  protected:
    static RegistrationLink link(const Scan& source, const Scan& target) {
        return register_pair(prepare(source), prepare(target), 1);
    }

    const Scan source = scan_from({3.6, 2.0, 1.6}, 2);
    const Scan target = scan_from({1.3, 2.2, 1.4}, 1);
    const RegistrationLink direct = link(source, target);
    // Of poses that should be one: the samples differ, and so do errors of a tenth of a voxel.
    const double same_distance = 0.003;
    const double same_angle = radians(0.1);
};

TEST_F(RegisterPairOfScans, IsAccepted) {
    EXPECT_EQ(direct.verdict, LinkVerdict::accepted);
    EXPECT_GE(direct.probability, 0.95);
    EXPECT_TRUE(direct.rivals.empty());
}

TEST_F(RegisterPairOfScans, GivesTheInverseTheOtherWayRound) {
    const RegistrationLink back = link(target, source);
    EXPECT_EQ(back.verdict, LinkVerdict::accepted);
    EXPECT_THAT(back.target_from_source,
                TransformNear(direct.target_from_source.inverse(), same_distance, same_angle));
}

TEST_F(RegisterPairOfScans, MovesWithTheFramesOfTheScans) {
    Random random(5);
    for (int run = 0; run < 3; ++run) {
        const Transform source_motion = test::random_transform(random, 3.0);
        const Transform target_motion = test::random_transform(random, 3.0);
        const RegistrationLink link =
            this->link(moved(source, source_motion), moved(target, target_motion));
        EXPECT_EQ(link.verdict, LinkVerdict::accepted);
        EXPECT_THAT(target_motion.inverse() * link.target_from_source * source_motion,
                    TransformNear(direct.target_from_source, same_distance, same_angle));
    }
}

TEST_F(RegisterPairOfScans, TakesThePointsInAnyOrder) {
    const RegistrationLink link = this->link(shuffled(source, 3), shuffled(target, 4));
    EXPECT_EQ(link.verdict, LinkVerdict::accepted);
    EXPECT_THAT(link.target_from_source,
                TransformNear(direct.target_from_source, same_distance, same_angle));
}

TEST_F(RegisterPairOfScans, HasTheSameBitsOnAnyThreads) {
    const RegistrationLink link =
        register_pair(prepare(source), prepare(target), 1, {}, test::with_threads(3));
    EXPECT_EQ(link.target_from_source.matrix(), direct.target_from_source.matrix());
    EXPECT_EQ(link.covariance, direct.covariance);
    EXPECT_EQ(link.probability, direct.probability);
}

TEST_F(RegisterPairOfScans, AGuessLeadsToTheSamePose) {
    Transform nudge = Transform::Identity();
    nudge.linear() = Eigen::AngleAxisd(radians(2.0), Vector3d::UnitY()).toRotationMatrix();
    nudge.translation() = Vector3d(0.08, -0.05, 0.06);
    const RegistrationLink link =
        register_pair_from(prepare(source), prepare(target), nudge * direct.target_from_source);
    EXPECT_EQ(link.verdict, LinkVerdict::accepted);
    EXPECT_THAT(link.target_from_source,
                TransformNear(direct.target_from_source, same_distance, same_angle));
}

/// Whoever guesses so badly has not ruled out other poses.
TEST_F(RegisterPairOfScans, AGuessOutOfReachOfTheIcpDoesNotStandForTheSearch) {
    const auto from_guess = [&](double off) {
        Transform guess = direct.target_from_source;
        guess.translation().x() += off;
        return register_pair_from(prepare(source), prepare(target), guess);
    };
    const RegistrationLink near = from_guess(0.1);
    const RegistrationLink far = from_guess(0.3);
    EXPECT_THAT(far.target_from_source,
                TransformNear(near.target_from_source, same_distance, same_angle));
    EXPECT_EQ(near.verdict, LinkVerdict::accepted);
    EXPECT_EQ(far.verdict, LinkVerdict::ambiguous);
}

TEST_F(RegisterPairOfScans, PeopleWhoWalkAboutDoNotMatter) {
    const Scan crowded = scan_with_people({3.6, 2.0, 1.6}, 2, {{{2.3, 1.6}, {5.0, 0.8}}});
    const RegistrationLink found = link(crowded, target);
    EXPECT_EQ(found.verdict, LinkVerdict::accepted);
    EXPECT_THAT(found.target_from_source,
                TransformNear(direct.target_from_source, same_distance, same_angle));
    const Scan other = scan_with_people({1.3, 2.2, 1.4}, 1, {{{1.2, 1.1}, {4.4, 2.2}}});
    EXPECT_EQ(link(crowded, other).verdict, LinkVerdict::accepted);
}

TEST_F(RegisterPairOfScans, IsRejectedBetweenOtherRooms) {
    Transform pose = Transform::Identity();
    pose.translation() = Vector3d(2.0, 1.8, 1.5);
    const RegistrationLink link =
        this->link(test::simulate_scan(test::other_room(), pose, 7, coarseness), target);
    EXPECT_NE(link.verdict, LinkVerdict::accepted);
    EXPECT_LT(link.probability, 0.5);
}

/// What a camera sees of the scan that looks along its x and is rolled about that, in the camera's
/// own frame: x right, y down, z forward.
Scan frame_of(const Scan& scan, double roll) {
    Eigen::Matrix3d optical_from_scan;
    optical_from_scan << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    optical_from_scan =
        Eigen::AngleAxisd(roll, Vector3d::UnitZ()).toRotationMatrix() * optical_from_scan;
    Scan frame;
    for (const Eigen::Vector3f& point : scan.cloud.positions) {
        if (point.x() > 0.6F * point.norm())
            frame.cloud.positions.emplace_back(optical_from_scan.cast<float>() * point);
    }
    return frame;
}

TEST(RegisterPairOfFrames, TakesNoPoseThatLaysACameraOnItsSide) {
    const Scan target = frame_of(scan_from({1.3, 2.2, 1.4}, 1), 0.0);
    const auto register_rolled = [&](double roll) {
        const Scan source = frame_of(scan_from({1.5, 2.0, 1.5}, 2), roll);
        return register_pair(prepare(source), prepare(target), 1);
    };
    const auto turned_by = [](const RegistrationLink& link) {
        return Eigen::AngleAxisd(link.target_from_source.linear()).angle();
    };
    EXPECT_NEAR(turned_by(register_rolled(radians(20.0))), radians(20.0), radians(1.0));
    const RegistrationLink on_its_side = register_rolled(radians(90.0));
    EXPECT_NE(on_its_side.verdict, LinkVerdict::accepted);
    EXPECT_GT(std::abs(turned_by(on_its_side) - radians(90.0)), radians(5.0));
}

}  // namespace
}  // namespace roomscribe
