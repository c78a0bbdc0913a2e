// SPDX-License-Identifier: MIT
// Odd but real input to the whole chain: a right result, or an honest word. docs/robustness.md has
// the table of what happens.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "support/odd_scans.hpp"
#include "support/shapes.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// What is said of a component, or link, that nothing speaks against.
constexpr double sure = 0.6;

struct Outcome {
    int exit_code = -1;
    std::string out;
    std::string err;
    json scene;
    std::vector<json> links;
    std::vector<std::optional<Transform>> poses;
};

Outcome run(std::vector<Scan> scans) {
    const TemporaryFolder folder;
    std::vector<std::string> arguments{"run"};
    for (std::size_t i = 0; i < scans.size(); ++i) {
        arguments.push_back((folder / ("scan" + std::to_string(i) + ".ply")).string());
        write_point_cloud(arguments.back(), scans[i].cloud);
    }
    const std::filesystem::path out = folder / "out";
    arguments.insert(arguments.end(), {"-o", out.string()});
    const ProgramResult result = roomscribe(arguments);
    Outcome outcome{result.exit_code, result.out, result.err, {}, {}, {}};
    if (result.exit_code != 0 && result.exit_code != 4) {
        ADD_FAILURE() << result.err;
        return outcome;
    }
    outcome.scene = read_json(out / "scene.json");
    outcome.links = read_json(out / "registration.json").at("links").get<std::vector<json>>();
    outcome.poses = read_poses(out / "poses.txt");
    return outcome;
}

std::vector<json> accepted(const Outcome& outcome) {
    std::vector<json> found;
    for (const json& component : outcome.scene.at("components")) {
        if (component.at("verdict") == "accepted") found.push_back(component);
    }
    return found;
}

void expect_all_in_doubt(const Outcome& outcome) {
    EXPECT_THAT(accepted(outcome), testing::IsEmpty());
    for (const json& component : outcome.scene.at("components"))
        EXPECT_LE(component.at("confidence").get<double>(), sure) << component;
}

/// The one room has the floor area and height that it should.
void expect_room(const Outcome& outcome, double area, double height) {
    const json& rooms = outcome.scene.at("rooms");
    ASSERT_EQ(rooms.size(), 1U);
    EXPECT_NEAR(rooms[0].at("area").get<double>(), area, 0.05 * area);
    EXPECT_NEAR(
        rooms[0].at("ceiling_height").get<double>() - rooms[0].at("floor_height").get<double>(),
        height, 0.05);
    EXPECT_GE(count_components(outcome.scene, "wall"), 4U);
}

/// The floor of l_shaped_room().
constexpr double l_area = 6.0 * 3.0 + 2.5 * 2.0;
constexpr double l_height = 2.6;

/// Each scan that has a place stands where it was taken, as seen from the first. `numbers` are
/// those of true_pose().
void expect_true_poses(const Outcome& outcome, const std::vector<std::size_t>& numbers,
                       double tolerance = 0.05) {
    ASSERT_EQ(outcome.poses.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!outcome.poses[i]) continue;
        const Transform truth = true_pose(numbers[0]).inverse() * true_pose(numbers[i]);
        const Transform error = truth.inverse() * *outcome.poses[i];
        EXPECT_LT(error.translation().norm(), tolerance) << i;
        EXPECT_LT(degrees(Eigen::AngleAxisd(error.linear()).angle()), 20.0 * tolerance) << i;
    }
}

std::size_t num_placed(const Outcome& outcome) {
    return static_cast<std::size_t>(std::count_if(outcome.poses.begin(), outcome.poses.end(),
                                                  [](const auto& pose) { return bool(pose); }));
}

std::string verdict_of(const Outcome& outcome, std::size_t link) {
    return outcome.links.at(link).at("verdict");
}

TEST(OddInput, LoneWallIsInDoubt) {
    expect_all_in_doubt(run(scan_lone_wall()));
}

TEST(OddInput, GroundOutdoorsIsInDoubt) {
    const Outcome outcome = run(scan_outdoors());
    expect_all_in_doubt(outcome);
    ASSERT_EQ(count_components(outcome.scene, "floor"), 1U);
    EXPECT_EQ(count_components(outcome.scene, "wall"), 0U);
    EXPECT_THAT(outcome.scene["components"][0]["evidence"]["alternative"].get<std::string>(),
                HasSubstr("outdoors"));
}

// It looks the same turned by half a turn, and upside down.
TEST(OddInput, EmptyRoomIsMeasuredAndItsPosesAreNotMadeUp) {
    const Outcome outcome = run(scan_empty_room());
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_EQ(verdict_of(outcome, 0), "ambiguous");
    expect_room(outcome, 20.0, 2.6);
    expect_all_in_doubt(outcome);
}

TEST(OddInput, StaircaseIsInDoubt) {
    const Outcome outcome = run(scan_staircase());
    EXPECT_NE(verdict_of(outcome, 0), "accepted");
    expect_all_in_doubt(outcome);
}

TEST(OddInput, RoomBehindGlassIsNoPartOfTheRoom) {
    const Outcome outcome = run(scan_through_glass());
    EXPECT_EQ(outcome.exit_code, 0);
    expect_room(outcome, 20.0, 2.7);
    EXPECT_EQ(count_components(outcome.scene, "door"), 1U);
}

TEST(OddInput, DuplicateScansChangeNothing) {
    std::vector<Scan> scans = scan_l_shaped_room(2);
    scans.push_back(scans[0]);
    scans.push_back(scans[1]);
    const Outcome outcome = run(scans);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(num_placed(outcome), 4U);
    expect_true_poses(outcome, {0, 1, 0, 1});
    expect_room(outcome, l_area, l_height);
}

TEST(OddInput, OneScanTwiceLiesOnItself) {
    const Scan scan = scan_l_shaped_room(1)[0];
    const Outcome outcome = run({scan, scan});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(num_placed(outcome), 2U);
    expect_true_poses(outcome, {0, 0}, 1e-3);
}

TEST(OddInput, TwoBuildingsAreTwoMaps) {
    const Outcome outcome = run(scan_two_buildings());
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("fall into 2 sets"));
    EXPECT_TRUE(outcome.poses.at(0) && outcome.poses.at(1));
    EXPECT_FALSE(outcome.poses.at(2) || outcome.poses.at(3));
    expect_room(outcome, l_area, l_height);
}

TEST(OddInput, MillimetresAreTold) {
    std::vector<Scan> scans = scan_l_shaped_room(2);
    for (Scan& scan : scans)
        scale_in_place(scan.cloud, 1000.0);
    const Outcome outcome = run(scans);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("millimetres"));
    expect_true_poses(outcome, {0, 1});
    expect_room(outcome, l_area, l_height);
}

// Nothing in its shape tells a room from its mirror image: it is described as it was given.
TEST(OddInput, MirroredRoomIsARoom) {
    std::vector<Scan> scans = scan_l_shaped_room(2);
    for (Scan& scan : scans)
        mirror(scan);
    const Outcome outcome = run(scans);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(verdict_of(outcome, 0), "accepted");
    expect_room(outcome, l_area, l_height);
}

TEST(OddInput, OneMirroredScanIsNotJoined) {
    std::vector<Scan> scans = scan_l_shaped_room(2);
    mirror(scans[1]);
    const Outcome outcome = run(scans);
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_NE(verdict_of(outcome, 0), "accepted");
    EXPECT_THAT(outcome.err, HasSubstr("no scan could be joined"));
}

TEST(OddInput, MovingPeopleKeepNoScanApart) {
    const Outcome outcome = run(scan_moving_people());
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(num_placed(outcome), 4U);
    expect_true_poses(outcome, {0, 1, 2, 3});
    expect_room(outcome, l_area, l_height);
}

void expect_room_without_outliers(double share) {
    std::vector<Scan> scans = scan_l_shaped_room(2);
    Random random(3);
    for (Scan& scan : scans)
        scatter_outliers(scan, share, random);
    const Outcome outcome = run(scans);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(verdict_of(outcome, 0), "accepted");
    expect_true_poses(outcome, {0, 1});
    expect_room(outcome, l_area, l_height);
}

TEST(OddInput, AFewOutliersChangeNothing) {
    expect_room_without_outliers(0.03);
}

TEST(OddInput, ManyOutliersAreLeftOut) {
    expect_room_without_outliers(0.3);
}

/// The room from two places, with so much noise, in m, in every coordinate.
std::vector<Scan> scan_with_noise(double noise, std::uint64_t seed) {
    std::vector<Scan> scans = scan_l_shaped_room(2);
    Random random(seed);
    for (Scan& scan : scans)
        add_noise(scan.cloud.positions, noise, random);
    return scans;
}

// A bookcase and the wall behind it would be one plane.
TEST(OddInput, NoiseOfTenCentimetresGivesTheRoomInDoubt) {
    const Outcome outcome = run(scan_with_noise(0.1, 4));
    EXPECT_EQ(outcome.exit_code, 0);
    expect_true_poses(outcome, {0, 1}, 0.15);
    for (const json& room : outcome.scene.at("rooms"))
        EXPECT_NEAR(room.at("area").get<double>(), l_area, 0.25 * l_area);
    expect_all_in_doubt(outcome);
}

TEST(OddInput, NoiseThatHidesTheRoomGivesNoRoom) {
    const Outcome outcome = run(scan_with_noise(0.3, 5));
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_NE(verdict_of(outcome, 0), "accepted");
    expect_all_in_doubt(outcome);
}

TEST(OddInput, AHundredPointsShowNothing) {
    const std::vector<Scan> scans = scan_l_shaped_room(2);
    const Outcome outcome = run({thinned_to(scans[0], 100), thinned_to(scans[1], 100)});
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_NE(verdict_of(outcome, 0), "accepted");
    expect_all_in_doubt(outcome);
}

TEST(OddInput, AnObjectIsNoRoom) {
    const Outcome outcome = run({scan_of_object()});
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_THAT(outcome.scene.at("components"), testing::IsEmpty());
    EXPECT_THAT(outcome.scene.at("rooms"), testing::IsEmpty());
    EXPECT_THAT(outcome.err, HasSubstr("no floor, ceiling or wall"));
}

}  // namespace
}  // namespace roomscribe::test
