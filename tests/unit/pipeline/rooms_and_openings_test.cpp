// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "roomscribe/pipeline/reconstruct.hpp"
#include "roomscribe/simulation/scenario_json.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"
#include "support/contexts.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Two rooms of 4 x 3.5 m and 3 x 3.5 m side by side with a door between them, a window in each,
/// and what may be taken for windows: a niche, a picture, a mirror.
constexpr const char* two_rooms = R"({
  "rooms": [ { "name": "left", "use": "office", "ceiling_height": 2.6,
               "outline": [[0, 0], [4, 0], [4, 3.5], [0, 3.5]] },
             { "name": "right", "use": "office", "ceiling_height": 2.6,
               "outline": [[4.15, 0], [7.15, 0], [7.15, 3.5], [4.15, 3.5]] } ],
  "openings": [ { "kind": "door", "room": "left", "at": [4, 1.0], "width": 0.86, "height": 2.0,
                  "recess": 0.05 },
                { "kind": "window", "room": "left", "at": [1.5, 3.5], "width": 1.2, "height": 1.1,
                  "sill": 0.9, "frame_width": 0.07, "recess": 0.12 },
                { "kind": "window", "room": "right", "at": [5.5, 3.5], "width": 1.0, "height": 1.2,
                  "sill": 0.9, "frame_width": 0.07, "recess": 0.1 },
                { "kind": "niche", "room": "left", "at": [2.6, 0], "width": 0.6, "height": 0.9,
                  "sill": 0.9, "recess": 0.15 } ],
  "items": [ { "kind": "picture", "at": [0.02, 1.2], "turn": 0, "size": [0.03, 0.9, 0.6],
               "elevation": 1.2 },
             { "kind": "mirror", "at": [7.14, 1.5], "turn": 180, "size": [0.02, 0.6, 1.2],
               "elevation": 0.7 },
             { "kind": "wardrobe", "at": [0.31, 2.6], "turn": 0, "size": [0.6, 1.2, 2.0] },
             { "kind": "table", "at": [2.0, 1.9], "turn": 0, "size": [0.8, 1.4, 0.75] } ],
  "coarseness": 4,
  "stations": [ { "at": [1.2, 0.8, 1.4] }, { "at": [3.2, 2.8, 1.5] }, { "at": [5.4, 1.2, 1.4] },
                { "at": [6.3, 2.6, 1.5] } ]
})";

struct Found {
    SimulatedScene truth;
    Reconstruction result;
};

Found find_in_two_rooms(std::uint64_t seed, const Context& context = {}) {
    Scenario scenario = scenario_from_json(two_rooms);
    scenario.seed = seed;
    Found found{simulate_scene(scenario), {}};
    found.result.map = found.truth.truth.map;
    interpret_map(found.result, {}, context);
    return found;
}

std::vector<const Component*> of_label(const Scene& scene, Label label) {
    std::vector<const Component*> components;
    for (const Component& component : scene.components) {
        if (component.label == label) components.push_back(&component);
    }
    return components;
}

Vector3d middle_of(const Component& component) {
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& corner : component.polygon)
        sum += corner;
    return sum / static_cast<double>(component.polygon.size());
}

double width_of(const Component& component) {
    return (component.polygon[1] - component.polygon[0]).norm();
}

double height_of(const Component& component) {
    return (component.polygon[2] - component.polygon[1]).norm();
}

// The world frame is turned at random with the seed.
class TwoRooms : public testing::TestWithParam<std::uint64_t> {};

TEST_P(TwoRooms, AreToldApart) {
    const Found found = find_in_two_rooms(GetParam());
    const Scene& scene = found.result.scene;
    ASSERT_EQ(scene.rooms.size(), 2U);
    std::vector<double> areas{scene.rooms[0].area, scene.rooms[1].area};
    std::sort(areas.begin(), areas.end());
    EXPECT_NEAR(areas[0], 10.5, 0.1);
    EXPECT_NEAR(areas[1], 14.0, 0.14);
    for (const Room& room : scene.rooms) {
        EXPECT_NEAR(room.floor_height, 0.0, 0.01);
        EXPECT_NEAR(room.ceiling_height, 2.6, 0.01);
        EXPECT_NEAR(room.volume, room.area * 2.6, 0.3);
        EXPECT_EQ(room.walls.size(), 4U);
        ASSERT_EQ(room.neighbors.size(), 1U);
        EXPECT_NE(room.neighbors[0].room, room.id);
        EXPECT_EQ(room.neighbors[0].through, of_label(scene, Label::door).at(0)->id);
    }
    EXPECT_EQ(of_label(scene, Label::floor).size(), 2U);
    EXPECT_EQ(of_label(scene, Label::ceiling).size(), 2U);
    EXPECT_EQ(of_label(scene, Label::wall).size(), 8U);
}

TEST_P(TwoRooms, HaveOneDoorAndTwoWindowsThatAreWhereTheyBelong) {
    const Found found = find_in_two_rooms(GetParam());
    for (const Label label : {Label::door, Label::door_frame, Label::window, Label::window_frame}) {
        SCOPED_TRACE(label_name(label));
        const auto components = of_label(found.result.scene, label);
        const auto expected = of_label(found.truth.truth.scene, label);
        ASSERT_EQ(components.size(), expected.size());
        for (const Component* component : components) {
            ASSERT_EQ(component->polygon.size(), 4U);
            EXPECT_FALSE(component->evidence.rule.empty());
            EXPECT_FALSE(component->parent.empty());
            const auto nearest = *std::min_element(
                expected.begin(), expected.end(), [&](const Component* a, const Component* b) {
                    return (middle_of(*a) - middle_of(*component)).norm() <
                           (middle_of(*b) - middle_of(*component)).norm();
                });
            EXPECT_LT((middle_of(*nearest) - middle_of(*component)).norm(), 0.1);
            // Three cells of the raster in which holes are found.
            EXPECT_NEAR(width_of(*component), width_of(*nearest), 0.12);
            EXPECT_NEAR(height_of(*component), height_of(*nearest), 0.12);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Turned, TwoRooms, testing::Values(1, 2, 3));

TEST(InterpretMap, AnOpenLeafIsTheDoorsWhereTheLiningGoesOnInItsPlane) {
    Scenario scenario = scenario_from_json(two_rooms);
    OpeningPlan& door = scenario.openings[0];
    door.leaf = LeafState::open;
    door.leaf_angle = 90.0;
    door.recess = 0.0;
    const SimulatedScene truth = simulate_scene(scenario);
    Reconstruction found;
    found.map = truth.truth.map;
    interpret_map(found);
    std::size_t count = 0;
    std::size_t right = 0;
    for (std::size_t i = 0; i < truth.truth.labels.size(); ++i) {
        if (truth.truth.labels[i] != Label::door) continue;
        ++count;
        right += found.labels.labels[i] == Label::door ? 1 : 0;
    }
    EXPECT_GT(count, 1000U);
    EXPECT_GE(static_cast<double>(right), 0.9 * static_cast<double>(count));
}

TEST(InterpretMap, ADoorWhoseLintelNobodySawHasTheUsualHeight) {
    const SimulatedScene truth = simulate_scene(scenario_from_json(R"({
      "rooms": [ { "name": "hall", "use": "corridor", "ceiling_height": 2.7,
                   "outline": [[0, 0], [5, 0], [5, 4], [0, 4]] } ],
      "openings": [ { "kind": "door", "room": "hall", "at": [2.5, 0], "width": 0.9,
                      "recess": 0.1 } ],
      "coarseness": 4,
      "stations": [ { "at": [1.6, 2.6, 1.1] }, { "at": [3.5, 2.7, 1.4] } ]
    })"));
    Reconstruction found;
    found.map = truth.truth.map;
    for (Eigen::Vector3f& position : found.map.cloud.positions) {
        const Vector3d place = truth.truth.scene.room_from_map * position.cast<double>();
        if (place.y() < 0.3 && place.z() > 1.65 && place.z() < 2.6 &&
            std::abs(place.x() - 2.5) < 0.9)
            position.setConstant(std::numeric_limits<float>::quiet_NaN());
    }
    interpret_map(found);
    const auto doors = of_label(found.scene, Label::door);
    ASSERT_EQ(doors.size(), 1U);
    EXPECT_NEAR(height_of(*doors[0]), 2.0, 0.1);
    EXPECT_NEAR(width_of(*doors[0]), 0.9, 0.1);
    EXPECT_TRUE(of_label(found.scene, Label::window).empty());
}

/// The two rooms with one or two parts of their description replaced.
Reconstruction find_with(const std::string& old_part, const std::string& new_part,
                         const std::string& other_old = "", const std::string& other_new = "") {
    std::string text = two_rooms;
    text.replace(text.find(old_part), old_part.size(), new_part);
    text.replace(text.find(other_old), other_old.size(), other_new);
    Scenario scenario = scenario_from_json(text);
    scenario.seed = 1;
    Reconstruction found;
    found.map = simulate_scene(scenario).truth.map;
    interpret_map(found);
    return found;
}

TEST(InterpretMap, WallBelowAHoleIsASillAndNoThreshold) {
    const Reconstruction found = find_with(R"("height": 1.1)", R"("height": 1.9)",
                                           R"("sill": 0.9, "frame_width": 0.07, "recess": 0.12)",
                                           R"("sill": 0.12, "frame_width": 0.07, "recess": 0.12)");
    EXPECT_EQ(of_label(found.scene, Label::window).size(), 2U);
    EXPECT_EQ(of_label(found.scene, Label::door).size(), 1U);
}

TEST(InterpretMap, APanelBesideAWidePassageIsNoLeafOfIt) {
    const Reconstruction found = find_with(
        R"({ "kind": "door", "room": "left", "at": [4, 1.0], "width": 0.86, "height": 2.0,
                  "recess": 0.05 })",
        R"({ "kind": "passage", "room": "left", "at": [4, 1.0], "width": 1.4, "height": 2.05 })",
        R"({ "kind": "table", "at": [2.0, 1.9])",
        R"({ "kind": "wardrobe", "at": [4.5, 1.72], "turn": 0, "size": [0.7, 0.04, 2.0] },
             { "kind": "table", "at": [2.0, 1.9])");
    EXPECT_TRUE(of_label(found.scene, Label::door).empty());
    const auto is_passage = [](const Component& component) { return component.kind == "opening"; };
    EXPECT_EQ(
        std::count_if(found.scene.components.begin(), found.scene.components.end(), is_passage), 1);
}

TEST(InterpretMap, GivesTheSameSceneOnOneAndTwoThreads) {
    const Found one = find_in_two_rooms(4, test::with_threads(1));
    const Found two = find_in_two_rooms(4, test::with_threads(2));
    EXPECT_EQ(one.result.labels.labels, two.result.labels.labels);
    EXPECT_EQ(one.result.labels.instances, two.result.labels.instances);
    ASSERT_EQ(one.result.scene.components.size(), two.result.scene.components.size());
    for (std::size_t i = 0; i < one.result.scene.components.size(); ++i) {
        EXPECT_EQ(one.result.scene.components[i].id, two.result.scene.components[i].id);
        EXPECT_EQ(one.result.scene.components[i].polygon, two.result.scene.components[i].polygon);
    }
}

}  // namespace
}  // namespace roomscribe
