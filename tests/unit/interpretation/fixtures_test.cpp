// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/interpretation/fixtures/find_fixtures.hpp"
#include "roomscribe/interpretation/fixtures/front_parts.hpp"
#include "roomscribe/interpretation/fixtures/furniture_fixtures.hpp"
#include "roomscribe/interpretation/fixtures/opening_motion.hpp"
#include "roomscribe/interpretation/fixtures/standoff_clusters.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// A front of 0.6 x 0.7 m in the plane x = 0 that looks along x, seen from 4 m before it. What
/// stands off hides the front behind it.
class FrontScan {
  public:
    explicit FrontScan(double noise) : noise_(noise) {}

    /// Points of a rectangle of the front, m along y and z, at a height before it.
    void add(double left, double right, double low, double high, double height, double spacing) {
        for (double y = left; y <= right; y += spacing) {
            for (double z = low; z <= high; z += spacing) {
                const bool is_hidden =
                    height == 0.0 && std::any_of(hides_.begin(), hides_.end(), [&](const auto& r) {
                        return y >= r[0] && y <= r[1] && z >= r[2] && z <= r[3];
                    });
                if (is_hidden) continue;
                map.cloud.positions.emplace_back(
                    Vector3d(height + noise_ * random_.normal(), y, z).cast<float>());
            }
        }
    }
    void add_front() { add(0.0, 0.6, 0.1, 0.8, 0.0, 0.006); }
    void add_bar(double left, double right, double low, double high, double height) {
        hides_.push_back({left, right, low, high});
        add(left, right, low, high, height, 0.005);
    }
    void add_strays(int count) {
        for (int i = 0; i < count; ++i) {
            map.cloud.positions.emplace_back(Vector3d(random_.uniform(-0.05, 0.12),
                                                      random_.uniform(0.0, 0.6),
                                                      random_.uniform(0.1, 0.8))
                                                 .cast<float>());
        }
    }

    ScanMap map;
    Vector3d sensor{4.0, 0.3, 0.55};

  private:
    double noise_;
    Random random_{7};
    std::vector<std::array<double, 4>> hides_;
};

MountingFace front() {
    MountingFace face;
    face.plane = {Vector3d::UnitX(), 0.0};
    face.along = Vector3d::UnitY();
    face.extent = {0.0, 0.6, 0.1, 0.8};
    face.component = 0;
    return face;
}

std::vector<Fixture> find(const ScanMap& scan, const Vector3d& sensor, const MountingFace& face,
                          const Context& context = {}, const FixtureSettings& settings = {}) {
    ScanMap map = scan;
    map.sections = {{"scan", 0, static_cast<std::uint32_t>(map.cloud.size()), sensor}};
    const SurfaceSample sample = sample_surface(map, estimate_scan_statistics(map.cloud));
    const std::array<MountingFace, 1> faces{face};
    return find_fixtures(map, sample, faces, settings, context);
}

std::vector<Fixture> find(const FrontScan& scan, const MountingFace& face = front()) {
    return find(scan.map, scan.sensor, face);
}

/// 160 mm long, 12 mm thick, its outer side 30 mm off the front.
FrontScan front_with_bar(double noise = 0.002) {
    FrontScan scan(noise);
    scan.add_bar(0.2, 0.36, 0.694, 0.706, 0.03);
    scan.add_front();
    return scan;
}

TEST(FindFixtures, MeasuresABar) {
    const std::vector<Fixture> fixtures = find(front_with_bar());
    ASSERT_EQ(fixtures.size(), 1U);
    const Component& bar = fixtures[0].component;
    EXPECT_EQ(bar.label, Label::handle);
    EXPECT_EQ(bar.kind, "bar_handle");
    EXPECT_LT((bar.box->center - Vector3d(0.015, 0.28, 0.7)).norm(), 0.005);
    EXPECT_NEAR(bar.box->size.x(), 0.16, 0.01);
    EXPECT_NEAR(bar.box->size.z(), 0.03, 0.004);
    EXPECT_GT(std::abs(bar.box->axes[0].y()), 0.999);
    ASSERT_TRUE(bar.grasp);
    EXPECT_GT(std::abs(bar.grasp->axis.z()), 0.999);
    EXPECT_LT(bar.grasp->approach.x(), -0.999);
    EXPECT_LT(bar.grasp->opening, 0.02);
    EXPECT_EQ(bar.evidence.points, fixtures[0].points.size());
}

TEST(FindFixtures, TellsAKnobFromABar) {
    FrontScan scan(0.002);
    scan.add_bar(0.53, 0.558, 0.686, 0.714, 0.028);
    scan.add_front();
    const std::vector<Fixture> fixtures = find(scan);
    ASSERT_EQ(fixtures.size(), 1U);
    EXPECT_EQ(fixtures[0].component.kind, "knob");
}

TEST(FindFixtures, FindsNothingOnABareFront) {
    for (const double noise : {0.001, 0.005, 0.01, 0.03}) {
        FrontScan scan(noise);
        scan.add_front();
        scan.add_strays(100);
        EXPECT_TRUE(find(scan).empty()) << noise;
    }
}

TEST(FindFixtures, JoinsTheEndsOfABarWhoseMiddleReturnedNothing) {
    FrontScan scan = front_with_bar();
    std::erase_if(scan.map.cloud.positions, [](const Eigen::Vector3f& point) {
        return point.x() > 0.02F && point.y() > 0.25F && point.y() < 0.31F;
    });
    const std::vector<Fixture> fixtures = find(scan);
    ASSERT_EQ(fixtures.size(), 1U);
    EXPECT_NEAR(fixtures[0].component.box->size.x(), 0.16, 0.01);
}

TEST(FindFixtures, FindsABarThatNoiseHidesByTheMeanOfItsPoints) {
    // Three deviations are 36 mm, more than the bar projects.
    const FrontScan scan = front_with_bar(0.012);
    const std::vector<Fixture> fixtures = find(scan);
    ASSERT_EQ(fixtures.size(), 1U);
    const Component& bar = fixtures[0].component;
    EXPECT_EQ(bar.kind, "bar_handle");
    EXPECT_LT((bar.box->center - Vector3d(0.015, 0.28, 0.7)).norm(), 0.015);
    EXPECT_NEAR(bar.box->size.x(), 0.16, 0.03);
    MountingFace untold = front();
    untold.component = no_component;
    EXPECT_TRUE(find(scan, untold).empty());
}

TEST(FindFixtures, FindsNothingOnABareNoisyFront) {
    FrontScan scan(0.012);
    scan.add_front();
    EXPECT_TRUE(find(scan).empty());
}

TEST(FindFixtures, KeepsTwoKnobsInARowApart) {
    FrontScan scan(0.002);
    scan.add_bar(0.2, 0.228, 0.686, 0.714, 0.028);
    scan.add_bar(0.29, 0.318, 0.686, 0.714, 0.028);
    scan.add_front();
    const std::vector<Fixture> fixtures = find(scan);
    ASSERT_EQ(fixtures.size(), 2U);
    EXPECT_EQ(fixtures[0].component.kind, "knob");
    EXPECT_EQ(fixtures[1].component.kind, "knob");
}

/// Clusters of the edge of a worktop, 1.2 m long, and of a bar 16 mm below it, on a face whose
/// points are 8 mm apart.
std::size_t num_clusters_below_worktop(float noise) {
    FaceRelief relief;
    relief.cell_size = 2.0;
    relief.num_columns = relief.num_rows = 1;
    relief.base = {0.0F};
    relief.noise = {noise};
    relief.spacing = {0.008F};
    std::vector<FacePoint> points;
    for (float along = 0.0F; along <= 1.2F; along += 0.008F) {
        points.push_back({along, 0.78F, 0.03F, 0, 0});
        points.push_back({along, 0.788F, 0.03F, 0, 0});
        if (along >= 0.4F && along <= 0.56F) points.push_back({along, 0.764F, 0.03F, 0, 0});
    }
    return find_standoff_clusters(relief, points).size();
}

TEST(FindStandoffClusters, PartsABarFromTheEdgeOfAWorktop) {
    EXPECT_EQ(num_clusters_below_worktop(0.001F), 2U);
    // Noise would part anything.
    EXPECT_EQ(num_clusters_below_worktop(0.008F), 1U);
}

TEST(FindFixtures, DropsWhatIsTooThickForTheGripper) {
    FrontScan scan(0.002);
    scan.add_bar(0.1, 0.5, 0.4, 0.5, 0.05);
    scan.add_front();
    EXPECT_TRUE(find(scan).empty());
}

/// 90 mm long, 36 mm high, 25 mm off the front.
FrontScan front_with_cup_pull() {
    FrontScan scan(0.002);
    scan.add_bar(0.255, 0.345, 0.652, 0.688, 0.025);
    scan.add_front();
    return scan;
}

TEST(FindFixtures, FindsTheCupPullOfADrawer) {
    const std::vector<Fixture> fixtures = find(front_with_cup_pull());
    ASSERT_EQ(fixtures.size(), 1U);
    const Component& pull = fixtures[0].component;
    EXPECT_EQ(pull.kind, "bar_handle");
    EXPECT_LT((pull.box->center - Vector3d(0.0125, 0.3, 0.67)).norm(), 0.005);
}

TEST(FindFixtures, FindsNoCupPullsOnLeaves) {
    MountingFace leaf = front();
    leaf.is_leaf = true;
    EXPECT_TRUE(find(front_with_cup_pull(), leaf).empty());
}

TEST(FindFixtures, TakesNoPlateForACupPull) {
    // Upright, or too high for fingers.
    for (const auto& [width, height] : {std::pair{0.036, 0.09}, std::pair{0.09, 0.07}}) {
        FrontScan scan(0.002);
        scan.add_bar(0.25, 0.25 + width, 0.4, 0.4 + height, 0.025);
        scan.add_front();
        EXPECT_TRUE(find(scan).empty());
    }
}

TEST(FindFixtures, DropsWhatReachesOverTheEdgeOfTheFront) {
    FrontScan scan(0.002);
    scan.add_bar(-0.05, 0.2, 0.694, 0.706, 0.03);
    scan.add_front();
    EXPECT_TRUE(find(scan).empty());
}

TEST(FindFixtures, LeavesStripsOfALeafBeforeItsOtherSideWhereNoScannerIsKnown) {
    FrontScan scan(0.001);
    scan.add_bar(0.2, 0.212, 0.3, 0.6, 0.04);
    scan.add_bar(0.4, 0.412, 0.3, 0.6, 0.04);
    scan.add_front();
    ScanMap map = scan.map;
    map.sections = {{"map", 0, static_cast<std::uint32_t>(map.cloud.size()), std::nullopt}};
    const SurfaceSample sample = sample_surface(map, estimate_scan_statistics(map.cloud));
    const MountingFace far_side = front();
    EXPECT_EQ(find_fixtures(map, sample, std::array{far_side}).size(), 2U);
    MountingFace near_side = front();
    near_side.plane.offset = 0.04;
    near_side.component = no_component;
    EXPECT_TRUE(find_fixtures(map, sample, std::array{far_side, near_side}).empty());
    // A bar is no face that goes on around it.
    near_side.extent = {0.19, 0.22, 0.29, 0.61};
    EXPECT_EQ(find_fixtures(map, sample, std::array{far_side, near_side}).size(), 2U);
}

TEST(FindFixtures, GivesNoGraspWhereTheFingersHaveNoRoom) {
    FrontScan scan = front_with_bar();
    FixtureSettings settings;
    settings.gripper.finger_depth = 0.04;
    const std::vector<Fixture> fixtures = find(scan.map, scan.sensor, front(), {}, settings);
    ASSERT_EQ(fixtures.size(), 1U);
    EXPECT_FALSE(fixtures[0].component.grasp);
}

TEST(FindFixtures, CallsALevelBarOnALeafALever) {
    FrontScan scan(0.002);
    scan.add_bar(0.06, 0.19, 0.392, 0.41, 0.055);
    scan.add_front();
    MountingFace leaf = front();
    leaf.is_leaf = true;
    const std::vector<Fixture> fixtures = find(scan, leaf);
    ASSERT_EQ(fixtures.size(), 1U);
    EXPECT_EQ(fixtures[0].component.kind, "lever_handle");
    // On a wall nothing but levers and door knobs.
    leaf.is_leaf = false;
    leaf.is_of_wall = true;
    EXPECT_EQ(find(scan, leaf).size(), 1U);
    EXPECT_TRUE(find(front_with_bar(), leaf).empty());
}

/// A frame, and 15 mm before it a sash of stiles 70 mm wide, about a pane that returns nothing.
FrontScan window_scan() {
    FrontScan scan(0.002);
    for (const double left : {0.05, 0.48})
        scan.add(left, left + 0.07, 0.1, 0.8, 0.015, 0.006);
    scan.add(0.0, 0.05, 0.1, 0.8, 0.0, 0.006);
    scan.add(0.55, 0.6, 0.1, 0.8, 0.0, 0.006);
    return scan;
}

MountingFace sashes() {
    MountingFace window = front();
    window.is_window = true;
    return window;
}

TEST(FindFixtures, FindsTheUprightLeverOfASash) {
    FrontScan scan = window_scan();
    std::erase_if(scan.map.cloud.positions, [](const Eigen::Vector3f& point) {
        return std::abs(point.y() - 0.085F) < 0.01F && std::abs(point.z() - 0.455F) < 0.055F;
    });
    scan.add(0.075, 0.095, 0.4, 0.51, 0.065, 0.006);
    const std::vector<Fixture> fixtures = find(scan, sashes());
    ASSERT_EQ(fixtures.size(), 1U);
    EXPECT_EQ(fixtures[0].component.kind, "lever_handle");
    EXPECT_NEAR(fixtures[0].component.box->center.z(), 0.455, 0.01);
    EXPECT_GT(std::abs(fixtures[0].component.box->axes[0].z()), 0.999);
}

TEST(FindFixtures, FindsNothingOnASashWithoutALever) {
    EXPECT_TRUE(find(window_scan(), sashes()).empty());
    // Bars, as furniture has, are no levers.
    FrontScan scan = window_scan();
    scan.add(0.075, 0.095, 0.2, 0.6, 0.065, 0.006);
    EXPECT_TRUE(find(scan, sashes()).empty());
}

TEST(FindFixtures, MovesWithTheMap) {
    const FrontScan scan = front_with_bar();
    Transform motion = Transform::Identity();
    motion.linear() = Eigen::AngleAxisd(0.7, Vector3d(0.3, -0.5, 0.8).normalized()).matrix();
    motion.translation() = Vector3d(4.0, -2.0, 1.0);
    ScanMap moved = scan.map;
    transform_in_place(moved.cloud, motion);
    MountingFace face = front();
    face.plane.normal = motion.linear() * Vector3d::UnitX();
    face.plane.offset = face.plane.normal.dot(motion.translation());
    face.along = motion.linear() * Vector3d::UnitY();
    const Vector3d up = face.plane.normal.cross(face.along);
    const double along = face.along.dot(motion.translation());
    const double above = up.dot(motion.translation());
    face.extent = {along, along + 0.6, above + 0.1, above + 0.8};
    const std::vector<Fixture> fixtures = find(moved, motion * scan.sensor, face);
    ASSERT_EQ(fixtures.size(), 1U);
    const Vector3d there = motion * find(scan)[0].component.box->center;
    EXPECT_LT((fixtures[0].component.box->center - there).norm(), 0.002);
}

TEST(FindFixtures, DoesNotDependOnTheNumberOfThreads) {
    const FrontScan scan = front_with_bar(0.004);
    const auto on_one = find(scan.map, scan.sensor, front(), {.num_threads = 1});
    const auto on_four = find(scan.map, scan.sensor, front(), {.num_threads = 4});
    ASSERT_EQ(on_one.size(), 1U);
    ASSERT_EQ(on_four.size(), 1U);
    EXPECT_EQ(on_one[0].component.box->center, on_four[0].component.box->center);
    EXPECT_EQ(on_one[0].points, on_four[0].points);
}

TEST(FindFixtures, GivesPointsAndParentToTheScene) {
    const FrontScan scan = front_with_bar();
    const std::vector<Fixture> fixtures = find(scan);
    Scene scene;
    scene.components.resize(1);
    scene.components[0].id = "furniture-1";
    scene.components[0].instance = 4;
    PointLabels labels;
    labels.labels.assign(scan.map.cloud.size(), Label::furniture);
    labels.instances.assign(scan.map.cloud.size(), 4);
    labels.confidences.assign(scan.map.cloud.size(), 0.5F);
    const std::array<MountingFace, 1> faces{front()};
    add_fixtures(fixtures, faces, scene, labels);
    ASSERT_EQ(scene.components.size(), 2U);
    EXPECT_EQ(scene.components[1].id, "handle-1");
    EXPECT_EQ(scene.components[1].parent, "furniture-1");
    EXPECT_EQ(scene.components[1].instance, 5);
    ASSERT_TRUE(scene.components[0].opens);
    EXPECT_EQ(std::count(labels.instances.begin(), labels.instances.end(), 5),
              static_cast<std::ptrdiff_t>(fixtures[0].points.size()));
}

Fixture fixture_at(double along, double above, const std::string& kind, bool is_upright) {
    Fixture fixture;
    OrientedBox box;
    box.center = {0.015, along, above};
    box.axes = {is_upright ? Vector3d::UnitZ() : Vector3d::UnitY(),
                is_upright ? Vector3d::UnitY() : Vector3d::UnitZ(), Vector3d::UnitX()};
    box.size = {0.16, 0.012, 0.03};
    fixture.component.kind = kind;
    fixture.component.box = box;
    return fixture;
}

OpeningMotion motion_of(const Fixture& fixture, const MountingFace& face) {
    const auto motions = find_opening_motions(std::span(&fixture, 1), std::span(&face, 1));
    return motions.at(0).value();
}

TEST(OpeningMotions, HingesADoorFarFromItsHandle) {
    const OpeningMotion motion = motion_of(fixture_at(0.55, 0.6, "bar_handle", true), front());
    EXPECT_EQ(motion.kind, MotionKind::hinged);
    EXPECT_NEAR(motion.point.y(), 0.0, 1e-9);
    // The handle moves off the piece.
    const Vector3d handle(0.0, 0.55, 0.6);
    EXPECT_GT(motion.direction.cross(handle - motion.point).x(), 0.0);
}

TEST(OpeningMotions, PullsALowFrontWithItsHandleInTheMiddle) {
    MountingFace face = front();
    face.extent.top = 0.3;
    const OpeningMotion motion = motion_of(fixture_at(0.3, 0.25, "bar_handle", false), face);
    EXPECT_EQ(motion.kind, MotionKind::pull);
    EXPECT_GT(motion.direction.x(), 0.999);
}

TEST(OpeningMotions, TurnsAFlapDown) {
    const OpeningMotion motion = motion_of(fixture_at(0.3, 0.75, "bar_handle", false), front());
    EXPECT_EQ(motion.kind, MotionKind::hinged);
    EXPECT_NEAR(motion.point.z(), 0.1, 1e-9);
    EXPECT_GT(motion.direction.cross(Vector3d(0.0, 0.3, 0.75) - motion.point).x(), 0.0);
}

TEST(OpeningMotions, SaysNothingOfAnUprightHandleAmidSeveralFronts) {
    MountingFace face = front();
    face.may_be_several = true;
    const Fixture lone = fixture_at(0.3, 0.6, "bar_handle", true);
    EXPECT_FALSE(find_opening_motions(std::span(&lone, 1), std::span(&face, 1)).at(0));
    const std::array pair{fixture_at(0.26, 0.6, "bar_handle", true),
                          fixture_at(0.34, 0.6, "bar_handle", true)};
    const auto motions = find_opening_motions(pair, std::span(&face, 1));
    ASSERT_TRUE(motions[0] && motions[1]);
    EXPECT_LT(motions[0]->point.y(), 0.26);
    EXPECT_GT(motions[1]->point.y(), 0.34);
}

constexpr double knob = 0.03;
constexpr double bar = 0.16;

TEST(PartByFixtures, KeepsAFrontOfOneFixtureWhole) {
    const WallRectangle extent{0.0, 0.6, 0.1, 0.8};
    const std::vector<FixturePlace> one{{0.3, 0.7, bar, false}};
    EXPECT_EQ(part_by_fixtures(extent, one).size(), 1U);
    EXPECT_EQ(part_by_fixtures(extent, {}).size(), 1U);
}

TEST(PartByFixtures, PartsDrawersAsFarAboveTheirHandlesAsTheUppermost) {
    const WallRectangle extent{0.0, 0.6, 0.1, 0.8};
    const std::vector<FixturePlace> handles{
        {0.3, 0.75, bar, false}, {0.3, 0.55, bar, false}, {0.3, 0.3, bar, false}};
    const std::vector<WallRectangle> parts = part_by_fixtures(extent, handles);
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_DOUBLE_EQ(parts[0].top, 0.8);
    EXPECT_DOUBLE_EQ(parts[0].bottom, 0.6);
    EXPECT_DOUBLE_EQ(parts[1].bottom, 0.35);
    EXPECT_DOUBLE_EQ(parts[2].bottom, 0.1);
}

TEST(PartByFixtures, PartsAPairOfDoorsBetweenTheirHandles) {
    const WallRectangle extent{0.0, 1.0, 0.1, 2.0};
    const std::vector<FixturePlace> handles{{0.46, 1.05, bar, true}, {0.56, 1.05, bar, true}};
    const std::vector<WallRectangle> parts = part_by_fixtures(extent, handles);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_NEAR(parts[0].end, 0.51, 1e-9);
    EXPECT_NEAR(parts[1].start, 0.51, 1e-9);
}

TEST(PartByFixtures, KeepsAWideDrawerWithTwoKnobsWhole) {
    const WallRectangle extent{0.0, 1.0, 0.1, 0.7};
    const std::vector<FixturePlace> knobs{{0.25, 0.6, knob, false},
                                          {0.75, 0.6, knob, false},
                                          {0.25, 0.3, knob, false},
                                          {0.75, 0.3, knob, false}};
    const std::vector<WallRectangle> parts = part_by_fixtures(extent, knobs);
    ASSERT_EQ(parts.size(), 2U);
    for (const WallRectangle& part : parts)
        EXPECT_DOUBLE_EQ(part.width(), 1.0);
}

TEST(FurnitureFixtures, FindsALineInThePrism) {
    const FrontScan scan = front_with_bar();
    ScanMap map = scan.map;
    map.sections = {{"scan", 0, static_cast<std::uint32_t>(map.cloud.size()), scan.sensor}};
    const SurfaceSample sample = sample_surface(map, estimate_scan_statistics(map.cloud));
    const std::array<MountingFace, 1> faces{front()};
    const std::vector<Fixture> fixtures = detect_furniture_fixtures(map, sample, faces, 1);
    ASSERT_EQ(fixtures.size(), 1U);
    EXPECT_EQ(fixtures[0].component.kind, "bar_handle");
    EXPECT_LT((fixtures[0].component.box->center - Vector3d(0.03, 0.28, 0.7)).norm(), 0.02);
    // Faces higher than the paper's 2 m have none.
    FurnitureFixturesSettings settings;
    settings.max_face_height = 0.5;
    EXPECT_TRUE(detect_furniture_fixtures(map, sample, faces, 1, settings).empty());
}

}  // namespace
}  // namespace roomscribe
