// SPDX-License-Identifier: MIT
#include "roomscribe/registration/scan_registration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using test::TransformNear;

/// A scanner at a place in the room, turned in any way at all.
Transform any_turn_at(Random& random, const Vector3d& place) {
    Transform pose = test::random_transform(random);
    pose.translation() = place;
    return pose;
}

Scan scan_l_shaped_room(const Transform& pose, std::uint64_t seed) {
    return test::simulate_scan(test::l_shaped_room(), pose, seed);
}

Scan scan_without_returns() {
    Scan scan;
    scan.cloud.positions.assign(5000, Eigen::Vector3f(NAN, NAN, NAN));
    return scan;
}

TEST(RegisterScans, FindsThePoseWhateverTheTurn) {
    Random random(1);
    for (std::uint64_t run = 0; run < 3; ++run) {
        const Transform first = any_turn_at(random, {1.3, 2.2, 1.4});
        const Transform second = any_turn_at(random, {3.6, 2.0, 1.6});
        constexpr double dense = 3.0;
        const std::vector<Scan> scans = {
            test::simulate_scan(test::l_shaped_room(), first, 2 * run, dense),
            test::simulate_scan(test::l_shaped_room(), second, 2 * run + 1, dense)};
        const Registration registration = register_scans(scans, 1).registration;
        ASSERT_EQ(registration.map_from_scan.size(), 2U);
        ASSERT_TRUE(registration.map_from_scan[1]);
        EXPECT_THAT(*registration.map_from_scan[0], TransformNear(Transform::Identity(), 0.0, 0.0));
        const Transform truth = first.inverse() * second;
        EXPECT_THAT(*registration.map_from_scan[1], TransformNear(truth, 0.01, radians(0.2)));

        ASSERT_EQ(registration.links.size(), 1U);
        const RegistrationLink& link = registration.links[0];
        EXPECT_EQ(link.verdict, LinkVerdict::accepted);
        EXPECT_EQ(link.source, 1U);
        EXPECT_EQ(link.target, 0U);
        EXPECT_GT(link.overlap, 0.4);
        EXPECT_GT(link.agreement, 0.8);
        EXPECT_LT(link.rmse, 0.03);
        EXPECT_TRUE(link.unobservable.empty());
        EXPECT_EQ(registration.residuals.size(), 2U);
        EXPECT_NEAR(registration.residuals[1], link.rmse, 1e-12);
    }
}

TEST(RegisterScans, RejectsScansOfDifferentRooms) {
    Random random(2);
    const std::vector<Scan> scans = {
        scan_l_shaped_room(any_turn_at(random, {1.3, 2.2, 1.4}), 1),
        test::simulate_scan(test::other_room(), any_turn_at(random, {2.0, 1.8, 1.5}), 2)};
    const Registration registration = register_scans(scans, 1).registration;
    ASSERT_EQ(registration.links.size(), 1U);
    EXPECT_EQ(registration.links[0].verdict, LinkVerdict::rejected);
    EXPECT_TRUE(registration.map_from_scan[0]);
    EXPECT_FALSE(registration.map_from_scan[1]);
    EXPECT_TRUE(std::isnan(registration.residuals[1]));
}

TEST(RegisterScans, ASequenceComesTogetherAndAStrangerStaysOut) {
    Random random(3);
    const std::vector<Transform> poses = {any_turn_at(random, {1.3, 2.2, 1.4}),
                                          any_turn_at(random, {2.0, 1.8, 1.5}),
                                          any_turn_at(random, {1.2, 3.4, 1.3})};
    const std::vector<Scan> scans = {scan_l_shaped_room(poses[0], 1),
                                     test::simulate_scan(test::other_room(), poses[1], 2),
                                     scan_l_shaped_room(poses[2], 3)};
    const Registration registration = register_scans(scans, 1).registration;
    EXPECT_FALSE(registration.map_from_scan[1]);
    ASSERT_TRUE(registration.map_from_scan[2]);
    EXPECT_THAT(*registration.map_from_scan[2],
                TransformNear(poses[0].inverse() * poses[2], 0.01, radians(0.2)));
}

/// Four scans of the L-shaped room and where they were taken.
struct ScannedRoom {
    std::vector<Scan> scans;
    std::vector<Transform> poses;
};

ScannedRoom scan_room_four_times(std::uint64_t seed) {
    Random random(seed);
    const std::vector<Vector3d> places = {
        {1.3, 2.2, 1.4}, {3.6, 2.0, 1.6}, {1.2, 3.4, 1.3}, {2.4, 1.6, 1.5}};
    ScannedRoom room;
    for (const Vector3d& place : places) {
        room.poses.push_back(any_turn_at(random, place));
        room.scans.push_back(
            test::simulate_scan(test::l_shaped_room(), room.poses.back(), random.next(), 4.0));
    }
    return room;
}

TEST(RegisterScans, TheOrderOfTheScansDecidesTheFrameAlone) {
    const ScannedRoom room = scan_room_four_times(11);
    const Registration as_taken = register_scans(room.scans, 1).registration;
    const std::vector<std::size_t> order = {2, 0, 3, 1};
    std::vector<Scan> shuffled;
    for (const std::size_t scan : order)
        shuffled.push_back(room.scans[scan]);
    const Registration other = register_scans(shuffled, 1).registration;

    EXPECT_EQ(as_taken.components, (std::vector<std::vector<std::size_t>>{{0, 1, 2, 3}}));
    ASSERT_EQ(other.links.size(), as_taken.links.size());
    EXPECT_GT(as_taken.links.size(), 3U);  // loops are closed
    for (std::size_t i = 0; i < order.size(); ++i) {
        ASSERT_TRUE(as_taken.map_from_scan[order[i]]);
        ASSERT_TRUE(other.map_from_scan[i]);
        const Transform expected =
            as_taken.map_from_scan[order[0]]->inverse() * *as_taken.map_from_scan[order[i]];
        EXPECT_THAT(*other.map_from_scan[i], TransformNear(expected, 1e-5, 1e-5));
        EXPECT_THAT(*as_taken.map_from_scan[i],
                    TransformNear(room.poses[0].inverse() * room.poses[i], 0.01, radians(0.2)));
    }
    for (const RegistrationLink& link : other.links) {
        const std::size_t source = std::max(order[link.source], order[link.target]);
        const std::size_t target = std::min(order[link.source], order[link.target]);
        const auto same =
            std::find_if(as_taken.links.begin(), as_taken.links.end(),
                         [&](const auto& l) { return l.source == source && l.target == target; });
        ASSERT_NE(same, as_taken.links.end());
        EXPECT_EQ(same->verdict, link.verdict);
    }
}

TEST(RegisterScans, ASequenceLinksEachScanToTheOneBefore) {
    const ScannedRoom room = scan_room_four_times(12);
    ScanRegistrationSettings settings;
    settings.sequence = ScanSequence::sequential;
    const Registration registration = register_scans(room.scans, 1, settings).registration;
    ASSERT_EQ(registration.links.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(registration.links[i].source, i + 1);
        EXPECT_EQ(registration.links[i].target, i);
    }
}

TEST(RegisterScans, KnownPosesAreAGuessOrKept) {
    ScannedRoom room = scan_room_four_times(13);
    Random random(1);
    std::vector<std::optional<Transform>> known;
    for (const Transform& pose : room.poses)
        known.emplace_back(test::small_transform(random, 0.02, 0.1) * pose);
    known[3].reset();
    ScanRegistrationSettings settings;
    const Registration guessed = register_scans(room.scans, known, 1, settings).registration;
    settings.known_poses = KnownPoseUse::fixed;
    const Registration kept = register_scans(room.scans, known, 1, settings).registration;
    for (std::size_t i = 0; i < room.scans.size(); ++i) {
        ASSERT_TRUE(guessed.map_from_scan[i]);
        EXPECT_THAT(*guessed.map_from_scan[i],
                    TransformNear(room.poses[0].inverse() * room.poses[i], 0.01, radians(0.2)));
        ASSERT_TRUE(kept.map_from_scan[i]);
        if (known[i]) {
            EXPECT_THAT(*kept.map_from_scan[i], TransformNear(*known[i], 1e-9, 1e-9));
        }
    }
    EXPECT_THROW(register_scans(room.scans, std::span(known).first(2), 1), InvalidArgument);
}

TEST(RegisterScans, HasTheSameBitsOnAnyThreads) {
    Random random(4);
    const std::vector<Scan> scans = {scan_l_shaped_room(any_turn_at(random, {1.3, 2.2, 1.4}), 1),
                                     scan_l_shaped_room(any_turn_at(random, {1.2, 3.4, 1.3}), 2)};
    for (const InitialAlignment method :
         {InitialAlignment::compatibility_graph, InitialAlignment::sample_consensus}) {
        ScanRegistrationSettings settings;
        settings.pair.initial_alignment = method;
        const auto one = register_scans(scans, 7, settings, test::with_threads(1)).registration;
        const auto many = register_scans(scans, 7, settings, test::with_threads(3)).registration;
        ASSERT_EQ(one.links.size(), many.links.size());
        EXPECT_EQ(one.links[0].target_from_source.matrix(),
                  many.links[0].target_from_source.matrix());
        EXPECT_EQ(one.links[0].covariance, many.links[0].covariance);
        EXPECT_EQ(one.links[0].rmse, many.links[0].rmse);
    }
}

TEST(RegisterScans, OneScanIsItsOwnMap) {
    Random random(5);
    const std::vector<Scan> scans = {scan_l_shaped_room(any_turn_at(random, {1.3, 2.2, 1.4}), 1)};
    const Registration registration = register_scans(scans, 1).registration;
    ASSERT_EQ(registration.map_from_scan.size(), 1U);
    EXPECT_THAT(*registration.map_from_scan[0], TransformNear(Transform::Identity(), 0.0, 0.0));
    EXPECT_TRUE(registration.links.empty());
}

TEST(RegisterScans, WantsAScan) {
    EXPECT_THROW(register_scans({}, 1), InvalidArgument);
}

TEST(RegisterScans, AScanWithoutReturnsHasNoPlaceAndHarmsNoOther) {
    Random random(6);
    const std::vector<Transform> poses = {any_turn_at(random, {1.3, 2.2, 1.4}),
                                          any_turn_at(random, {1.2, 3.4, 1.3})};
    const std::vector<Scan> scans = {scan_l_shaped_room(poses[0], 1), scan_without_returns(),
                                     scan_without_returns(), scan_without_returns(),
                                     scan_l_shaped_room(poses[1], 2)};
    const Registration registration = register_scans(scans, 1).registration;
    EXPECT_FALSE(registration.map_from_scan[1]);
    ASSERT_TRUE(registration.map_from_scan[4]);
    EXPECT_THAT(*registration.map_from_scan[4],
                TransformNear(poses[0].inverse() * poses[1], 0.01, radians(0.2)));
}

TEST(RegisterScans, NothingButScansWithoutReturns) {
    const std::vector<Scan> scans = {scan_without_returns(), scan_without_returns()};
    const Registration registration = register_scans(scans, 1).registration;
    EXPECT_TRUE(registration.map_from_scan[0]);
    EXPECT_FALSE(registration.map_from_scan[1]);
}

TEST(RegisterScans, SaysWhatItDerived) {
    Random random(7);
    const std::vector<Scan> scans = {scan_l_shaped_room(any_turn_at(random, {1.3, 2.2, 1.4}), 1)};
    ScanRegistrationSettings settings;
    settings.fpfh_radius = 0.77;
    const auto derived = register_scans(scans, 1, settings).derived_values;
    const auto find = [&derived](std::string_view name) {
        for (const DerivedValue& value : derived) {
            if (value.name == name) return value;
        }
        return DerivedValue{};
    };
    EXPECT_NEAR(find("registration.noise").value, 0.002, 0.001);
    EXPECT_GT(find("registration.coarse_voxel").value, find("registration.fine_voxel").value);
    EXPECT_EQ(find("registration.fpfh_radius").value, 0.77);
    EXPECT_EQ(find("registration.fpfh_radius").reason, "set by hand");
}

TEST(RegisterScans, StopsWhenCancelled) {
    Random random(8);
    const std::vector<Scan> scans = {scan_l_shaped_room(any_turn_at(random, {1.3, 2.2, 1.4}), 1)};
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    EXPECT_THROW(register_scans(scans, 1, {}, context), Cancelled);
}

}  // namespace
}  // namespace roomscribe
