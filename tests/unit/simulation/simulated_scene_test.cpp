// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/simulated_scene.hpp"

#include <cstring>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/contexts.hpp"

namespace roomscribe {
namespace {

const Scenario& small_office() {
    static const Scenario scenario =
        plan_scene(SceneKind::office, 11,
                   {.scanner = ScannerKind::terrestrial, .scans_per_room = 2, .coarseness = 6.0});
    return scenario;
}

bool same_bits(const PointCloud& a, const PointCloud& b) {
    return a.size() == b.size() && std::memcmp(a.positions.data(), b.positions.data(),
                                               a.size() * sizeof(Eigen::Vector3f)) == 0;
}

TEST(SimulatedScene, HasTheSameBitsOnAnyThreadsAndEveryTime) {
    const SimulatedScene one = simulate_scene(small_office(), test::with_threads(1));
    const SimulatedScene many = simulate_scene(small_office(), test::with_threads(3));
    ASSERT_EQ(one.scans.size(), many.scans.size());
    for (std::size_t i = 0; i < one.scans.size(); ++i)
        EXPECT_TRUE(same_bits(one.scans[i].cloud, many.scans[i].cloud));
    EXPECT_EQ(one.truth.labels, many.truth.labels);
    EXPECT_EQ(one.truth.instances, many.truth.instances);
    EXPECT_EQ(one.truth.acceptable, many.truth.acceptable);
    for (std::size_t i = 0; i < one.truth.scene.components.size(); ++i) {
        EXPECT_EQ(one.truth.scene.components[i].visible, many.truth.scene.components[i].visible);
    }
}

TEST(SimulatedScene, PosesBringTheScansIntoTheMap) {
    const SimulatedScene scene = simulate_scene(small_office());
    std::size_t point = 0;
    for (std::size_t i = 0; i < scene.scans.size(); ++i) {
        for (const Eigen::Vector3f& position : scene.scans[i].cloud.positions) {
            const Eigen::Vector3f& in_map = scene.truth.map.cloud.positions[point++];
            if (!is_finite(position)) {
                EXPECT_FALSE(is_finite(in_map));
                continue;
            }
            const Eigen::Vector3d expected = scene.truth.map_from_scan[i] * position.cast<double>();
            ASSERT_LT((in_map.cast<double>() - expected).norm(), 1e-4);
        }
    }
    EXPECT_EQ(point, scene.truth.labels.size());
}

TEST(SimulatedScene, PointsLieOnThePolygonsTheyBelongTo) {
    const SimulatedScene scene = simulate_scene(small_office());
    const GroundTruth& truth = scene.truth;
    std::size_t num_compared = 0;
    std::size_t num_off = 0;
    for (std::size_t i = 0; i < truth.labels.size(); ++i) {
        const bool is_pure = truth.acceptable[i] == label_bit(truth.labels[i]);
        if (truth.instances[i] < 0 || !is_pure ||
            (truth.labels[i] != Label::floor && truth.labels[i] != Label::wall &&
             truth.labels[i] != Label::ceiling)) {
            continue;
        }
        const Component& component =
            truth.scene.components[static_cast<std::size_t>(truth.instances[i])];
        ASSERT_EQ(component.label, truth.labels[i]);
        const Eigen::Vector3d normal = (component.polygon[1] - component.polygon[0])
                                           .cross(component.polygon[2] - component.polygon[1])
                                           .normalized();
        const double distance = std::abs(
            normal.dot(truth.map.cloud.positions[i].cast<double>() - component.polygon[0]));
        ++num_compared;
        // 2 mm of noise, 2.5 mm of unevenness, and smear at grazing incidence.
        num_off += distance > 0.015 ? 1 : 0;
    }
    EXPECT_GT(num_compared, 50'000U);
    EXPECT_LT(static_cast<double>(num_off), 1e-3 * static_cast<double>(num_compared));
}

TEST(SimulatedScene, TheWayToTheRoomFrameLevelsTheMap) {
    const SimulatedScene scene = simulate_scene(small_office());
    const Transform& room_from_map = scene.truth.scene.room_from_map;
    for (const Component& component : scene.truth.scene.components) {
        if (component.label != Label::floor) continue;
        for (const Eigen::Vector3d& corner : component.polygon)
            EXPECT_NEAR((room_from_map * corner).z(), 0.0, 1e-9);
    }
    // The world frame is turned somehow: levelled it would give the game away.
    EXPECT_GT(rotation_angle(room_from_map.linear()), 0.05);
}

TEST(SimulatedScene, AnotherSeedIsAnotherBuilding) {
    const Scenario a = plan_scene(SceneKind::flat, 1);
    const Scenario b = plan_scene(SceneKind::flat, 2);
    EXPECT_NE(a.rooms[0].outline, b.rooms[0].outline);
    EXPECT_EQ(a.rooms[0].outline, plan_scene(SceneKind::flat, 1).rooms[0].outline);
}

TEST(SimulatedScene, RefusesWhatMakesNoSense) {
    EXPECT_THROW(plan_scene(SceneKind::room, 1, {.coarseness = 0.0}), InvalidArgument);
    EXPECT_THROW(plan_scene(SceneKind::room, 1, {.scans_per_room = -1}), InvalidArgument);
    Scenario scenario = small_office();
    scenario.stations.clear();
    EXPECT_THROW(simulate_scene(scenario), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
