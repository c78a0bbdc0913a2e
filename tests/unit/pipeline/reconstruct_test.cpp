// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/reconstruct.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

using testing::ElementsAre;

Transform standing_at(double x, double y, double yaw) {
    Transform pose = Transform::Identity();
    pose.translate(Eigen::Vector3d(x, y, 1.5));
    pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    return pose;
}

std::size_t count_in(const Reconstruction& result, std::size_t scan, Label label) {
    const MapSection& section = result.map.sections[scan];
    const auto first = result.labels.labels.begin() + section.first;
    return static_cast<std::size_t>(std::count(first, first + section.count, label));
}

/// Two scans of one room and one of another, which nothing joins to them.
class TwoBuildings : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        const Scenario room = test::l_shaped_room();
        const std::vector<Scan> scans{
            test::simulate_scan(room, standing_at(1.5, 1.5, 0.3), 1),
            test::simulate_scan(room, standing_at(2.5, 1.2, 2.0), 2),
            test::simulate_scan(test::other_room(), standing_at(2.0, 1.5, 1.0), 3)};
        result_ = new Reconstruction(reconstruct(scans));
    }
    static void TearDownTestSuite() { delete result_; }

    static Reconstruction* result_;
};

Reconstruction* TwoBuildings::result_ = nullptr;

TEST_F(TwoBuildings, AreTwoMaps) {
    EXPECT_THAT(result_->registration->components, ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
    ASSERT_EQ(result_->apart.size(), 1U);
    const Reconstruction& apart = result_->apart[0];
    ASSERT_EQ(apart.map.sections.size(), 1U);
    EXPECT_EQ(apart.map.sections[0].name, result_->map.sections[2].name);
    EXPECT_TRUE(apart.registration->map_from_scan[0]->isApprox(Transform::Identity()));
    EXPECT_EQ(apart.scene.rooms.size(), 1U);
    EXPECT_NEAR(apart.scene.rooms[0].ceiling_height - apart.scene.rooms[0].floor_height, 2.9, 0.05);
    EXPECT_EQ(result_->scene.rooms.size(), 1U);
}

TEST_F(TwoBuildings, HaveLabelsForEveryPointInTheFirst) {
    const MapSection& section = result_->map.sections[2];
    EXPECT_TRUE(std::isnan(result_->map.cloud.positions[section.first].x()));
    for (const Label label : {Label::floor, Label::wall, Label::ceiling}) {
        EXPECT_GT(count_in(*result_, 2, label), section.count / 50);
        EXPECT_EQ(count_in(*result_, 2, label), count_in(result_->apart[0], 0, label));
    }
    for (std::uint32_t i = section.first; i < section.first + section.count; ++i)
        ASSERT_EQ(result_->labels.instances[i], -1);
}

/// Scans of a furnished room by a scanner that lies on its side or hangs upside down, always alike.
class MountedOtherwise : public testing::TestWithParam<double> {};

TEST_P(MountedOtherwise, DoesNotMakeAWallTheFloor) {
    const Eigen::AngleAxisd mount(GetParam(), Eigen::Vector3d::UnitX());
    std::vector<Scan> scans = test::scan_furnished_room(4);
    for (Scan& scan : scans) {
        for (Eigen::Vector3f& point : scan.cloud.positions)
            point = mount.cast<float>() * point;
    }
    const Reconstruction result = reconstruct(scans);
    const Eigen::Vector3d up = result.scene.room_from_map.linear().row(2).transpose();
    EXPECT_GT(up.dot(mount * Eigen::Vector3d::UnitZ()), 0.99);
}

INSTANTIATE_TEST_SUITE_P(Turned, MountedOtherwise,
                         testing::Values(0.0, radians(90.0), radians(180.0)));

/// A rectangle of points, 1 cm apart, from a corner along two edges, with 2 mm of noise.
void add_rectangle(Scan& scan, const Eigen::Vector3d& corner, const Eigen::Vector3d& first,
                   const Eigen::Vector3d& second) {
    Random random(scan.cloud.size());
    std::vector<Eigen::Vector3f> points;
    for (double a = 0.0; a <= first.norm(); a += 0.01) {
        for (double b = 0.0; b <= second.norm(); b += 0.01) {
            const Eigen::Vector3d point = corner + a * first.normalized() + b * second.normalized();
            points.emplace_back(point.cast<float>());
        }
    }
    test::add_noise(points, 0.002, random);
    scan.cloud.positions.insert(scan.cloud.positions.end(), points.begin(), points.end());
}

double share_of(const Reconstruction& result, Label label) {
    const auto& labels = result.labels.labels;
    return static_cast<double>(std::count(labels.begin(), labels.end(), label)) /
           static_cast<double>(labels.size());
}

// A camera looks along z and has y down.

/// Three scans of a furnished room that somebody merged, in the room's own coordinates.
TEST(AMergedMap, IsInterpretedTheSameAsAScanOfARun) {
    test::LabelledCloud room = test::simulate_furnished_room(3);
    Scan merged;
    merged.name = "merged.ply";
    merged.cloud = room.cloud;
    const Reconstruction run = reconstruct(std::vector<Scan>{merged});
    Reconstruction map;
    map.map = map_of_cloud(std::move(merged));
    interpret_map(map);

    EXPECT_FALSE(run.map.sections[0].sensor_position);
    EXPECT_FALSE(run.map.inferred_views.empty());
    EXPECT_EQ(run.labels.labels, map.labels.labels);
    EXPECT_THAT(run.derived_values, testing::Contains(testing::Field(
                                        &DerivedValue::name, "structure.jumps_from_origin")));
    ASSERT_EQ(run.scene.rooms.size(), 1U);
    EXPECT_NEAR(run.scene.rooms[0].ceiling_height - run.scene.rooms[0].floor_height, 2.7, 0.02);
    std::size_t num_right = 0;
    for (std::size_t i = 0; i < room.labels.size(); ++i)
        num_right += run.labels.labels[i] == room.labels[i] ? 1 : 0;
    EXPECT_GT(static_cast<double>(num_right), 0.9 * static_cast<double>(room.labels.size()));
}

TEST(OneCameraFrame, OfAWallAloneIsAWall) {
    Scan frame;
    add_rectangle(frame, {-0.8, -0.6, 1.5}, {1.6, 0, 0}, {0, 1.2, 0});
    const Reconstruction result = reconstruct({&frame, 1});
    EXPECT_GT(share_of(result, Label::wall), 0.95);
    EXPECT_LT(result.scene.room_from_map.linear()(2, 1), -0.99);
}

TEST(OneCameraFrame, OfAWorktopShowsNoFloor) {
    Scan frame;
    add_rectangle(frame, {-1.0, -0.9, 2.0}, {2.0, 0, 0}, {0, 1.3, 0});  // the wall
    add_rectangle(frame, {-0.9, 0.4, 1.4}, {1.8, 0, 0}, {0, 0, 0.6});   // the top
    add_rectangle(frame, {-0.9, 0.4, 1.4}, {1.8, 0, 0}, {0, 0.5, 0});   // its front
    const Reconstruction result = reconstruct({&frame, 1});
    EXPECT_LT(result.scene.room_from_map.linear()(2, 1), -0.99);
    EXPECT_EQ(share_of(result, Label::floor), 0.0);
    EXPECT_GT(share_of(result, Label::wall), 0.4);
}

}  // namespace
}  // namespace roomscribe
