// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/room_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "block_scene.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/evaluate.hpp"
#include "roomscribe/evaluation/evaluation_summary.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using test::BlockScene;
using test::prediction_of;

/// Ground truth, correct, false positives.
using Counts = std::array<std::uint64_t, 3>;

Counts counts_of(const DetectionCounts& counts) {
    return {counts.ground_truth, counts.correct, counts.false_positives};
}

using Outline = std::vector<Eigen::Vector2d>;

Outline rectangle(double x, double y, double width, double depth) {
    return {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}};
}

double area_of(const Outline& outline) {
    double twice = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Eigen::Vector2d& a = outline[i];
        const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return twice / 2.0;
}

Room make_room(const std::string& id, const Outline& outline, double floor = 0.0,
               double height = 2.5) {
    Room room;
    room.id = id;
    for (const Eigen::Vector2d& corner : outline)
        room.polygon.emplace_back(corner.x(), corner.y(), floor);
    room.floor_height = floor;
    room.ceiling_height = floor + height;
    room.area = area_of(outline);
    room.volume = room.area * height;
    return room;
}

/// Truth and a result that have rooms and nothing else, both in the room's frame.
struct Rooms {
    GroundTruth truth = BlockScene().truth;
    Prediction found = prediction_of(truth);

    Rooms(std::vector<Room> true_rooms, std::vector<Room> found_rooms) {
        truth.scene.rooms = std::move(true_rooms);
        found.scene->rooms = std::move(found_rooms);
    }

    RoomError error() const { return evaluate_rooms(truth, found); }
};

void join(std::vector<Room>& rooms, std::size_t a, std::size_t b, const std::string& door) {
    rooms.at(a).neighbors.push_back({rooms.at(b).id, door});
    rooms.at(b).neighbors.push_back({rooms.at(a).id, door});
}

TEST(RoomError, OfAShiftedRectangleIsThatOfItsOverlap) {
    const auto shifted_by = [](double distance) {
        return Rooms({make_room("a", rectangle(0, 0, 4, 3))},
                     {make_room("room-1", rectangle(distance, 0, 4, 3))})
            .error();
    };
    // IoU = (4 - d) / (4 + d): one half at d = 4/3.
    const RoomError near = shifted_by(1.0);
    EXPECT_EQ(counts_of(near.rooms), (Counts{1, 1, 0}));
    EXPECT_NEAR(near.matches.at(0).iou, 0.6, 1e-9);
    EXPECT_NEAR(near.matches[0].area_error, 0.0, 1e-12);
    EXPECT_EQ(counts_of(shifted_by(1.33).rooms), (Counts{1, 1, 0}));
    EXPECT_EQ(counts_of(shifted_by(1.34).rooms), (Counts{1, 0, 1}));
}

TEST(RoomError, OfSizesIsSignedAndRelative) {
    // 4 m x 3 m x 2.5 m, found 1 % longer and 2 cm too low.
    const RoomError error = Rooms({make_room("a", rectangle(0, 0, 4, 3))},
                                  {make_room("room-1", rectangle(0, 0, 4.04, 3), 0.02, 2.48)})
                                .error();
    EXPECT_NEAR(error.matches.at(0).area_error, 0.01, 1e-9);
    EXPECT_NEAR(error.matches[0].height_error, -0.02, 1e-9);
    EXPECT_NEAR(error.matches[0].volume_error, 1.01 * 2.48 / 2.5 - 1.0, 1e-9);
    Evaluation evaluation;
    evaluation.rooms = error;
    const EvaluationSummary summary = summarize({&evaluation, 1});
    ASSERT_EQ(summary.height_errors.size(), 1U);
    EXPECT_NEAR(summary.height_errors[0], 0.02, 1e-9);
    EXPECT_NEAR(summary.area_errors.at(0), 0.01, 1e-9);
}

TEST(RoomError, OfAnLTakenForItsBoundingBox) {
    // 4 x 4 without a corner of side s: IoU = (16 - s s) / 16.
    const auto without_corner = [](double s) {
        return Outline{{0, 0}, {4, 0}, {4, 4 - s}, {4 - s, 4 - s}, {4 - s, 4}, {0, 4}};
    };
    const auto error = [&](double s) {
        return Rooms({make_room("a", without_corner(s))},
                     {make_room("room-1", rectangle(0, 0, 4, 4))})
            .error();
    };
    EXPECT_NEAR(error(2.0).matches.at(0).iou, 0.75, 1e-9);
    EXPECT_NEAR(error(2.0).matches.at(0).area_error, 1.0 / 3.0, 1e-9);
    EXPECT_EQ(counts_of(error(2.82).rooms), (Counts{1, 1, 0}));
    EXPECT_EQ(counts_of(error(2.84).rooms), (Counts{1, 0, 1}));
    // Found as it is, clockwise and from another corner.
    Outline turned = without_corner(2.0);
    std::reverse(turned.begin(), turned.end());
    std::rotate(turned.begin(), turned.begin() + 2, turned.end());
    const RoomError same =
        Rooms({make_room("a", without_corner(2.0))}, {make_room("room-1", turned)}).error();
    EXPECT_NEAR(same.matches.at(0).iou, 1.0, 1e-9);
}

TEST(RoomError, OfASplitRoomIsAFalseOneOrWorse) {
    const std::vector<Room> truth{make_room("a", rectangle(0, 0, 6, 3))};
    const auto split_at = [&](double x) {
        return counts_of(Rooms(truth, {make_room("room-1", rectangle(0, 0, x, 3)),
                                       make_room("room-2", rectangle(x, 0, 6 - x, 3))})
                             .error()
                             .rooms);
    };
    EXPECT_EQ(split_at(4.0), (Counts{1, 1, 1}));
    EXPECT_EQ(split_at(2.9), (Counts{1, 1, 1}));
    // In three: no part is half of it.
    EXPECT_EQ(counts_of(Rooms(truth, {make_room("room-1", rectangle(0, 0, 2, 3)),
                                      make_room("room-2", rectangle(2, 0, 2, 3)),
                                      make_room("room-3", rectangle(4, 0, 2, 3))})
                            .error()
                            .rooms),
              (Counts{1, 0, 3}));
}

TEST(RoomError, OfMergedRoomsIsAMissOrWorse) {
    const auto merged = [](double width) {
        return counts_of(Rooms({make_room("a", rectangle(0, 0, 4, 3)),
                                make_room("b", rectangle(4.1, 0, width, 3))},
                               {make_room("room-1", rectangle(0, 0, 4.1 + width, 3))})
                             .error()
                             .rooms);
    };
    EXPECT_EQ(merged(3.0), (Counts{2, 1, 0}));
    EXPECT_EQ(merged(4.0), (Counts{2, 0, 1}));  // 4 of 8.1
}

TEST(RoomError, MatchesBestFirstAndOnce) {
    // Two found rooms in one true room and one of them nearer to a second one.
    const RoomError error =
        Rooms({make_room("a", rectangle(0, 0, 4, 3)), make_room("b", rectangle(0.5, 0, 4, 3))},
              {make_room("room-1", rectangle(0.4, 0, 4, 3)),
               make_room("room-2", rectangle(0.3, 0, 4, 3))})
            .error();
    ASSERT_EQ(error.matches.size(), 2U);
    EXPECT_EQ(error.matches[0].true_id, "b");
    EXPECT_EQ(error.matches[0].predicted_id, "room-1");
    EXPECT_EQ(error.matches[1].true_id, "a");
    EXPECT_EQ(error.matches[1].predicted_id, "room-2");
}

TEST(RoomError, IsTheSameInAnyFrame) {
    const Rooms rooms(
        {make_room("a", rectangle(0, 0, 4, 3)), make_room("b", rectangle(5, 0, 2, 3))},
        {make_room("room-1", rectangle(0.5, 0, 4, 3)),
         make_room("room-2", rectangle(5, 0.2, 2, 3))});
    const RoomError there = rooms.error();
    Random random(11);
    for (int i = 0; i < 10; ++i) {
        Rooms moved = rooms;
        const Transform truth_moves = test::random_transform(random, 10.0);
        const Transform found_moves = test::random_transform(random, 10.0);
        moved.truth.scene = transformed_scene(rooms.truth.scene, truth_moves);
        for (Transform& pose : moved.truth.map_from_scan)
            pose = truth_moves * pose;
        moved.found.scene = transformed_scene(*rooms.found.scene, found_moves);
        for (auto& pose : moved.found.map_from_scan)
            pose = found_moves * *pose;
        const RoomError here = moved.error();
        EXPECT_EQ(counts_of(here.rooms), (Counts{2, 2, 0}));
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_EQ(here.matches.at(k).predicted_id, there.matches.at(k).predicted_id);
            EXPECT_NEAR(here.matches[k].iou, there.matches[k].iou, 1e-9);
        }
    }
    // A result that takes another direction for up still has its floor where it is; turned by t
    // about y it looks cos(t) as long.
    Rooms leaning({make_room("a", rectangle(0, 0, 4, 3))}, {make_room("a", rectangle(0, 0, 4, 3))});
    const Transform lean(Eigen::AngleAxisd(radians(20.0), Eigen::Vector3d::UnitY()));
    for (Eigen::Vector3d& corner : leaning.found.scene->rooms[0].polygon)
        corner = lean * corner;
    EXPECT_NEAR(leaning.error().matches.at(0).iou, std::cos(radians(20.0)), 1e-9);
}

TEST(RoomError, TellsStoreysApart) {
    const Outline outline = rectangle(0, 0, 4, 3);
    const std::vector<Room> storeys{make_room("low", outline, 0.0),
                                    make_room("high", outline, 2.8)};
    const RoomError both =
        Rooms(storeys, {make_room("room-1", outline, 2.81), make_room("room-2", outline, 0.01)})
            .error();
    EXPECT_EQ(counts_of(both.rooms), (Counts{2, 2, 0}));
    for (const RoomMatch& match : both.matches)
        EXPECT_EQ(match.predicted_id, match.true_id == "high" ? "room-1" : "room-2");
    // A table's top taken for the floor is in the storey, the next floor is not.
    EXPECT_EQ(counts_of(Rooms({storeys[0]}, {make_room("room-1", outline, 0.75)}).error().rooms),
              (Counts{1, 1, 0}));
    EXPECT_EQ(counts_of(Rooms({storeys[0]}, {make_room("room-1", outline, 2.8)}).error().rooms),
              (Counts{1, 0, 1}));
}

/// A floor and a wall of a room, which were seen by these shares: 12 m2 and 10 m2.
void add_surfaces(GroundTruth& truth, const std::string& room, double floor, double wall) {
    Component component;
    component.parent = room;
    component.verdict = Verdict::accepted;
    component.id = "floor-" + room;
    component.label = Label::floor;
    component.polygon = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
    component.visible = floor;
    truth.scene.components.push_back(component);
    component.id = "wall-" + room;
    component.label = Label::wall;
    component.polygon = test::upright_rectangle({0, 0, 0}, 4, 2.5);
    component.visible = wall;
    truth.scene.components.push_back(component);
}

TEST(RoomError, LeavesOutRoomsThatWereHardlySeen) {
    Rooms rooms({make_room("a", rectangle(0, 0, 4, 3)), make_room("b", rectangle(5, 0, 4, 3))},
                {make_room("room-1", rectangle(0, 0, 4, 3))});
    add_surfaces(rooms.truth, "a", 0.9, 0.9);
    add_surfaces(rooms.truth, "b", 0.1, 0.5);
    EXPECT_NEAR(room_visibility(rooms.truth.scene, rooms.truth.scene.rooms[1]),
                (12 * 0.1 + 10 * 0.5) / 22.0, 1e-12);
    EXPECT_EQ(counts_of(rooms.error().rooms), (Counts{1, 1, 0}));
    // Found whole or in part, it is neither hit nor false; where nothing is, it is false.
    rooms.found.scene->rooms.push_back(make_room("room-2", rectangle(5, 0, 4, 3)));
    EXPECT_EQ(counts_of(rooms.error().rooms), (Counts{1, 1, 0}));
    rooms.found.scene->rooms[1] = make_room("room-2", rectangle(5, 0, 1, 1));
    EXPECT_EQ(counts_of(rooms.error().rooms), (Counts{1, 1, 0}));
    rooms.found.scene->rooms[1] = make_room("room-2", rectangle(8.4, 0, 1.3, 1));
    EXPECT_EQ(counts_of(rooms.error().rooms), (Counts{1, 1, 1}));
    rooms.truth.scene.components.back().visible = 0.6;
    EXPECT_EQ(counts_of(rooms.error().rooms), (Counts{2, 1, 1}));
}

TEST(RoomError, CountsNeighboursOncePerPair) {
    const std::vector<Room> apart{make_room("a", rectangle(0, 0, 4, 3)),
                                  make_room("b", rectangle(5, 0, 4, 3)),
                                  make_room("c", rectangle(10, 0, 4, 3))};
    std::vector<Room> true_rooms = apart;
    join(true_rooms, 0, 1, "door-1");
    join(true_rooms, 0, 1, "door-2");
    join(true_rooms, 1, 2, "door-3");
    const auto counts = [&](const std::vector<std::array<std::size_t, 2>>& pairs,
                            std::optional<double> third_door) {
        std::vector<Room> found_rooms = apart;
        for (const auto& [a, b] : pairs)
            join(found_rooms, a, b, "x");
        Rooms rooms(true_rooms, found_rooms);
        for (const std::string id : {"door-1", "door-2", "door-3"}) {
            Component door;
            door.id = id;
            door.label = Label::door;
            if (id == "door-3") door.visible = third_door;
            rooms.truth.scene.components.push_back(door);
        }
        return counts_of(rooms.error().neighbors);
    };
    EXPECT_EQ(counts({}, 1.0), (Counts{2, 0, 0}));
    EXPECT_EQ(counts({{0, 1}}, 1.0), (Counts{2, 1, 0}));
    EXPECT_EQ(counts({{0, 1}, {0, 1}, {1, 2}}, 1.0), (Counts{2, 2, 0}));
    EXPECT_EQ(counts({{0, 1}, {0, 2}}, 1.0), (Counts{2, 1, 1}));
    // Nobody saw the third door: to find it is neither right nor wrong.
    EXPECT_EQ(counts({{0, 1}}, 0.2), (Counts{1, 1, 0}));
    EXPECT_EQ(counts({{0, 1}, {1, 2}}, 0.2), (Counts{1, 1, 0}));
}

TEST(RoomError, ANeighbourThatIsNoRoomIsFalse) {
    std::vector<Room> found_rooms{make_room("room-1", rectangle(0, 0, 4, 3)),
                                  make_room("room-2", rectangle(20, 0, 4, 3))};
    join(found_rooms, 0, 1, "door-1");
    const RoomError error = Rooms({make_room("a", rectangle(0, 0, 4, 3))}, found_rooms).error();
    EXPECT_EQ(counts_of(error.rooms), (Counts{1, 1, 1}));
    EXPECT_EQ(counts_of(error.neighbors), (Counts{0, 0, 1}));
}

TEST(RoomError, IsPartOfTheEvaluationWhereTruthHasRooms) {
    const Rooms rooms({make_room("a", rectangle(0, 0, 4, 3))},
                      {make_room("room-1", rectangle(0, 0, 4, 3))});
    ASSERT_TRUE(evaluate_result(rooms.truth, rooms.found).rooms);
    EXPECT_EQ(evaluate_result(rooms.truth, rooms.found).rooms->rooms.correct, 1U);
    EXPECT_FALSE(evaluate_result(BlockScene().truth, rooms.found).rooms);
}

}  // namespace
}  // namespace roomscribe
