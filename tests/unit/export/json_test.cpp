// SPDX-License-Identifier: MIT
#include "roomscribe/export/json.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;
using testing::Not;

Scene small_scene() {
    Scene scene;
    scene.room_from_map.translation() = Eigen::Vector3d(1.0, -2.5, 0.1234567);
    Component door;
    door.id = "door-1";
    door.label = Label::door;
    door.instance = 3;
    door.parent = "room-1";
    door.polygon = {{0, 0, 0}, {0.9, 0, 0}, {0.9, 0, 2.05}, {0, 0, 2.05}};
    door.confidence = 0.75;
    door.verdict = Verdict::doubtful;
    door.evidence = {"size of a door", 1200, 0.5, std::nullopt, 0.004, "cupboard"};
    Component handle;
    handle.id = "handle-1";
    handle.label = Label::handle;
    handle.kind = "lever";
    handle.instance = 4;
    handle.parent = "door-1";
    handle.box = OrientedBox{};
    handle.box->size = {0.12, 0.02, 0.03};
    handle.grasp = Grasp{{0.5, 1.0, 0.9}, {0, 0, 1}, {0, -1, 0}, 0.02};
    handle.visible = 0.4;
    handle.confidence = 1.0;
    handle.verdict = Verdict::accepted;
    Component ghost;
    ghost.id = "ghost-1";
    ghost.verdict = Verdict::rejected;
    scene.components = {door, ghost, handle};
    Room room;
    room.id = "room-1";
    room.ceiling_height = 2.5;
    room.area = 12.0;
    room.volume = 30.0;
    room.walls = {"wall-1", "wall-2"};
    room.neighbors = {{"room-2", "door-1"}};
    scene.rooms = {room};
    return scene;
}

TEST(SceneToJson, GivesExactlyTheDocumentedText) {
    EXPECT_EQ(scene_to_json(small_scene()), R"({
  "format": "roomscribe-scene",
  "version": 1,
  "units": "m",
  "to_room": [
    [1.0, 0.0, 0.0, 1.0],
    [0.0, 1.0, 0.0, -2.5],
    [0.0, 0.0, 1.0, 0.123457],
    [0.0, 0.0, 0.0, 1.0]
  ],
  "components": [
    {
      "id": "door-1",
      "label": "door",
      "instance": 3,
      "parent": "room-1",
      "polygon": [
        [0.0, 0.0, 0.0],
        [0.9, 0.0, 0.0],
        [0.9, 0.0, 2.05],
        [0.0, 0.0, 2.05]
      ],
      "confidence": 0.75,
      "verdict": "doubtful",
      "evidence": {
        "rule": "size of a door",
        "points": 1200,
        "coverage": 0.5,
        "rms": 0.004,
        "alternative": "cupboard"
      }
    },
    {
      "id": "handle-1",
      "label": "handle",
      "kind": "lever",
      "instance": 4,
      "parent": "door-1",
      "box": {
        "center": [0.0, 0.0, 0.0],
        "axes": [
          [1.0, 0.0, 0.0],
          [0.0, 1.0, 0.0],
          [0.0, 0.0, 1.0]
        ],
        "size": [0.12, 0.02, 0.03]
      },
      "grasp": {
        "position": [0.5, 1.0, 0.9],
        "axis": [0.0, 0.0, 1.0],
        "approach": [0.0, -1.0, 0.0],
        "opening": 0.02
      },
      "visible": 0.4,
      "confidence": 1.0,
      "verdict": "accepted",
      "evidence": {
        "points": 0
      }
    }
  ],
  "rooms": [
    {
      "id": "room-1",
      "floor_height": 0.0,
      "ceiling_height": 2.5,
      "area": 12.0,
      "volume": 30.0,
      "walls": ["wall-1", "wall-2"],
      "neighbours": [
        {
          "room": "room-2",
          "through": "door-1"
        }
      ]
    }
  ]
}
)");
}

TEST(SceneToJson, OfNothingStaysAScene) {
    const Scene scene = scene_from_json(scene_to_json({}));
    EXPECT_TRUE(scene.components.empty());
    EXPECT_TRUE(scene.rooms.empty());
    EXPECT_TRUE(scene.room_from_map.isApprox(Transform::Identity()));
}

TEST(SceneToJson, WritesNoMinusZeroAndRefusesNaN) {
    Scene scene = small_scene();
    scene.components[0].polygon[0].x() = -1e-9;
    EXPECT_THAT(scene_to_json(scene), Not(HasSubstr("-0.0")));
    scene.components[0].polygon[0].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(scene_to_json(scene), InvalidArgument);
}

TEST(SceneToJson, SurvivesNamesThatAreNotUtf8OrThatLookLikeJson) {
    Scene scene = small_scene();
    scene.components[0].kind = "a\"b\\c\n\xff{";
    const Scene read = scene_from_json(scene_to_json(scene));
    EXPECT_EQ(read.components[0].kind, "a\"b\\c\n\xEF\xBF\xBD{");
}

TEST(SceneFromJson, GivesBackWhatWasWritten) {
    const Scene scene = small_scene();
    const Scene read = scene_from_json(scene_to_json(scene));
    ASSERT_EQ(read.components.size(), 2U);
    const Component& door = read.components[0];
    EXPECT_EQ(door.id, "door-1");
    EXPECT_EQ(door.label, Label::door);
    EXPECT_EQ(door.instance, 3);
    EXPECT_EQ(door.verdict, Verdict::doubtful);
    EXPECT_EQ(door.polygon, scene.components[0].polygon);
    EXPECT_EQ(door.evidence.points, 1200U);
    EXPECT_EQ(door.evidence.coverage, 0.5);
    EXPECT_EQ(door.evidence.occluded, std::nullopt);
    EXPECT_EQ(door.evidence.alternative, "cupboard");
    EXPECT_FALSE(door.box);
    ASSERT_TRUE(read.components[1].box);
    EXPECT_EQ(read.components[1].box->size, scene.components[2].box->size);
    EXPECT_FALSE(door.visible);
    EXPECT_FALSE(door.grasp);
    EXPECT_EQ(read.components[1].visible, 0.4);
    ASSERT_TRUE(read.components[1].grasp);
    EXPECT_EQ(read.components[1].grasp->position, Eigen::Vector3d(0.5, 1.0, 0.9));
    EXPECT_EQ(read.components[1].grasp->axis, Eigen::Vector3d(0, 0, 1));
    EXPECT_EQ(read.components[1].grasp->approach, Eigen::Vector3d(0, -1, 0));
    EXPECT_EQ(read.components[1].grasp->opening, 0.02);
    ASSERT_EQ(read.rooms.size(), 1U);
    EXPECT_EQ(read.rooms[0].walls, scene.rooms[0].walls);
    EXPECT_EQ(read.rooms[0].neighbors[0].through, "door-1");
    EXPECT_TRUE(read.room_from_map.isApprox(scene.room_from_map, 1e-6));
}

RC_GTEST_PROP(SceneFromJson, IsUndoneByWritingAgain, ()) {
    Scene scene;
    const auto number = [] { return *rc::gen::inRange(-9'000'000, 9'000'000) * 1.37e-5; };
    const auto vector = [&] { return Eigen::Vector3d(number(), number(), number()); };
    scene.room_from_map.linear() =
        Eigen::AngleAxisd(number(), (vector() + Eigen::Vector3d(1e-3, 0, 0)).normalized())
            .toRotationMatrix();
    scene.room_from_map.translation() = vector();
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
        Component component;
        component.id = *rc::gen::arbitrary<std::string>();
        component.kind = "text";
        component.label = static_cast<Label>(*rc::gen::inRange(0, 10));
        component.instance = *rc::gen::arbitrary<std::int32_t>();
        component.evidence.points = *rc::gen::arbitrary<std::uint64_t>();
        component.polygon = {vector(), vector(), vector()};
        scene.components.push_back(component);
    }
    const std::string text = scene_to_json(scene);
    RC_ASSERT(scene_to_json(scene_from_json(text)) == text);
}

/// The message of the IoError that reading the text throws.
std::string complaint(const std::string& text) {
    try {
        scene_from_json(text, "room.json");
    } catch (const IoError& error) {
        return error.what();
    }
    return "";
}

std::string with_component(const std::string& component) {
    return R"({"format": "roomscribe-scene", "version": 1, "components": [)" + component + "]}";
}

TEST(SceneFromJson, SaysWhatIsWrongAndWhere) {
    EXPECT_THAT(complaint("{\"format\": "), HasSubstr("byte 12"));
    EXPECT_THAT(complaint("[]"), HasSubstr("must be an object"));
    EXPECT_THAT(complaint("{}"), HasSubstr("\"format\" is missing"));
    EXPECT_THAT(complaint(R"({"format": "gltf", "version": 1})"), HasSubstr("roomscribe-scene"));
    EXPECT_THAT(complaint(R"({"format": "roomscribe-scene", "version": 2})"), HasSubstr("version"));
    EXPECT_THAT(complaint(with_component(R"({"id": "a", "label": "roof"})")),
                HasSubstr("components[0].label: \"roof\" is not a label"));
    EXPECT_THAT(complaint(with_component(R"({"id": "a", "label": "wall", "polygon": [[0, 1]]})")),
                HasSubstr("components[0].polygon[0]: has 2 elements instead of 3"));
    EXPECT_THAT(complaint(with_component(R"({"id": "a", "label": "wall", "instance": 1e99})")),
                HasSubstr("components[0].instance"));
    EXPECT_THAT(complaint(
                    R"({"format": "roomscribe-scene", "version": 1, "to_room":
                [[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})"),
                HasSubstr("to_room: is not a rigid motion"));
    EXPECT_THAT(complaint("{}"), HasSubstr("room.json"));
}

TEST(SceneFromJson, IgnoresUnknownKeys) {
    const Scene scene = scene_from_json(
        with_component(R"({"id": "a", "label": "wall", "mood": 0.5, "grasp": {"x": [1]}})"));
    EXPECT_EQ(scene.components.at(0).label, Label::wall);
}

TEST(SceneFromJson, TakesNullForAbsent) {
    const Scene scene = scene_from_json(
        with_component(R"({"id": "a", "label": "wall", "parent": null, "visible": null})"));
    EXPECT_EQ(scene.components.at(0).parent, "");
    EXPECT_FALSE(scene.components[0].visible);
    EXPECT_THAT(complaint(with_component(R"({"id": null, "label": "wall"})")),
                HasSubstr("\"id\" is missing"));
}

TEST(RegistrationToJson, ListsScansAndLinks) {
    Registration registration;
    registration.map_from_scan = {Transform::Identity(), std::nullopt};
    registration.residuals = {0.0121, std::numeric_limits<double>::quiet_NaN()};
    RegistrationLink link;
    link.source = 1;
    link.verdict = LinkVerdict::ambiguous;
    link.probability = 0.875;
    link.loops = LoopCheck::agrees;
    link.overlap = 0.7130000001;
    link.inliers = 42;
    link.covariance(0, 0) = 1.23456789e-9;
    link.unobservable.emplace_back(Eigen::Matrix<double, 6, 1>::Unit(3));
    link.stop_reason = "small_step";
    registration.links = {link};
    registration.components = {{0}, {1}};
    registration.overlaps = {0.25, 0.0};
    registration.is_doubtful = {true, false};
    registration.covariances.assign(2, 0.5 * Eigen::Matrix<double, 6, 6>::Identity());
    const std::vector<std::string> names{"a.pcd", "b.pcd"};
    const std::string text = registration_to_json(registration, names);
    EXPECT_THAT(text, HasSubstr("\"name\": \"b.pcd\",\n      \"placed\": false,\n      "
                                "\"residual\": null"));
    EXPECT_THAT(text, HasSubstr("\"residual\": 0.0121"));
    EXPECT_THAT(text, HasSubstr("\"verdict\": \"ambiguous\""));
    EXPECT_THAT(text, HasSubstr("\"probability\": 0.875,\n      \"loops\": \"agrees\""));
    EXPECT_THAT(text, HasSubstr("\"overlap\": 0.713,"));
    EXPECT_THAT(text,
                HasSubstr("\"overlap\": 0.25,\n      \"doubtful\": true,\n      \"covariance\": "
                          "[\n        [0.5, 0.0, 0.0, 0.0, 0.0, 0.0]"));
    EXPECT_THAT(text, HasSubstr("\"components\": [\n    [0],\n    [1]\n  ]"));
    EXPECT_THAT(text, HasSubstr("[1.23457e-09, 0.0, 0.0, 0.0, 0.0, 0.0]"));
    EXPECT_THAT(text, HasSubstr("[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]"));
    EXPECT_THAT(text, HasSubstr("\"stop_reason\": \"small_step\""));
    EXPECT_THAT(text, Not(HasSubstr("rival")));
    EXPECT_THROW(registration_to_json(registration, {}), InvalidArgument);
}

TEST(RegistrationFromJson, GivesBackWhatWasWritten) {
    Registration registration;
    registration.map_from_scan = {Transform::Identity(), std::nullopt};
    RegistrationLink link;
    link.source = 1;
    link.target_from_source.translation() = Eigen::Vector3d(1, 2, 3);
    link.verdict = LinkVerdict::ambiguous;
    link.probability = 0.625;
    link.overlap = 0.5;
    link.agreement = 0.75;
    link.rmse = 0.01;
    link.inliers = 42;
    link.covariance(2, 3) = 1.25e-7;
    link.unobservable.emplace_back(Eigen::Matrix<double, 6, 1>::Unit(4));
    link.rivals = {Transform::Identity()};
    registration.links = {link, RegistrationLink{}};
    const std::vector<std::string> names{"a.pcd", "b.pcd"};
    registration.links[1].loops = LoopCheck::disagrees;
    registration.components = {{0}, {1}};
    registration.residuals = {0.0125, std::nan("")};
    registration.overlaps = {0.25, 0.0};
    registration.is_doubtful = {true, false};
    registration.covariances.resize(2);
    registration.covariances[0] = Eigen::Matrix<double, 6, 6>::Identity() * 0.5;
    const RegistrationRecord record =
        registration_from_json(registration_to_json(registration, names));
    ASSERT_EQ(record.scans.size(), 2U);
    EXPECT_EQ(record.scans[0].name, "a.pcd");
    EXPECT_TRUE(record.scans[0].is_placed);
    EXPECT_TRUE(record.scans[0].is_doubtful);
    EXPECT_EQ(record.scans[0].residual, 0.0125);
    EXPECT_EQ(record.scans[0].overlap, 0.25);
    EXPECT_EQ(record.scans[0].covariance, registration.covariances[0]);
    EXPECT_FALSE(record.scans[1].is_placed);
    EXPECT_FALSE(record.scans[1].residual);
    EXPECT_FALSE(record.scans[1].covariance);
    EXPECT_EQ(record.components, registration.components);
    const std::vector<RegistrationLink>& links = record.links;
    ASSERT_EQ(links.size(), 2U);
    EXPECT_EQ(links[0].source, 1U);
    EXPECT_EQ(links[0].target, 0U);
    EXPECT_TRUE(links[0].target_from_source.isApprox(link.target_from_source));
    EXPECT_EQ(links[0].verdict, LinkVerdict::ambiguous);
    EXPECT_EQ(links[0].probability, 0.625);
    EXPECT_EQ(links[0].overlap, 0.5);
    EXPECT_EQ(links[0].agreement, 0.75);
    EXPECT_EQ(links[0].rmse, 0.01);
    EXPECT_EQ(links[0].inliers, 42U);
    EXPECT_EQ(links[0].covariance, link.covariance);
    EXPECT_EQ(links[0].unobservable, link.unobservable);
    EXPECT_EQ(links[0].rivals.size(), 1U);
    EXPECT_TRUE(links[1].rivals.empty());
    EXPECT_EQ(links[0].loops, LoopCheck::none);
    EXPECT_EQ(links[1].loops, LoopCheck::disagrees);
    EXPECT_EQ(links[1].verdict, LinkVerdict::rejected);
}

TEST(RegistrationFromJson, SaysWhatIsWrongAndWhere) {
    const auto complaint_of = [](const std::string& links) -> std::string {
        try {
            registration_from_json(
                R"({"format": "roomscribe-registration", "version": 1, "scans": [{}], "links": [)" +
                links + "]}");
        } catch (const IoError& error) {
            return error.what();
        }
        return "";
    };
    const std::string pose = R"("target_from_source": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])";
    EXPECT_THAT(complaint_of(R"({"source": 0, "target": 1, "verdict": "accepted", )" + pose + "}"),
                HasSubstr("links[0]: names a scan that is not among the 1"));
    EXPECT_THAT(complaint_of(R"({"source": 0, "target": 0, "verdict": "good", )" + pose + "}"),
                HasSubstr("links[0].verdict: \"good\" is not a verdict"));
    EXPECT_THAT(complaint_of(R"({"source": 0, "target": 0, "verdict": "accepted"})"),
                HasSubstr("\"target_from_source\" is missing"));
    EXPECT_THROW(registration_from_json(scene_to_json({})), IoError);
}

TEST(LayOutJson, KeepsKeyOrderAndPutsFlatArraysOnOneLine) {
    EXPECT_EQ(lay_out_json(R"({"b":[1,2.5],"a":{"x":[[1],[]]},"e":{}})"),
              "{\n  \"b\": [1, 2.5],\n  \"a\": {\n    \"x\": [\n      [1],\n      []\n    ]\n  },\n"
              "  \"e\": {}\n}\n");
    EXPECT_THROW(lay_out_json("{"), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
