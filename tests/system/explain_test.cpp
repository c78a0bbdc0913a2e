// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/export/json.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Along x, up z, with its lower left corner at `corner`.
std::vector<Eigen::Vector3d> upright(const Eigen::Vector3d& corner, double width, double height) {
    const Eigen::Vector3d x(width, 0, 0);
    const Eigen::Vector3d z(0, 0, height);
    return {corner, corner + x, corner + x + z, corner + z};
}

Component make(const std::string& id, Label label, const std::string& parent) {
    Component component;
    component.id = id;
    component.label = label;
    component.parent = parent;
    component.confidence = 0.93;
    component.verdict = Verdict::accepted;
    component.evidence.rule = "the rule of " + id;
    component.evidence.points = 1000;
    component.evidence.scans = 3;
    return component;
}

/// A room of 5 m x 4 m with a door and a window in a wall, a cupboard with a drawer and a handle,
/// and a second room behind the door; in a map that stands on its head, 10 m off.
Scene small_scene() {
    Scene scene;
    Component wall = make("wall-1", Label::wall, "room-1");
    wall.polygon = upright({0, 0, 0}, 5, 2.5);
    wall.evidence.rms = 0.0042;
    Component door = make("door-1", Label::door, "wall-1");
    door.polygon = upright({1.0, -0.1, 0}, 0.86, 2.03);
    door.evidence.coverage = 0.84;
    door.evidence.occluded = 0.1;
    Component frame = make("door_frame-1", Label::door_frame, "wall-1");
    frame.polygon = upright({0.94, 0, 0}, 0.98, 2.09);
    Component window = make("window-1", Label::window, "wall-1");
    window.polygon = upright({3.0, -0.05, 0.9}, 1.2, 1.1);
    window.verdict = Verdict::doubtful;
    window.confidence = 0.61;
    window.evidence.alternative = "niche";
    window.evidence.occluded = 0.45;
    Component cupboard = make("furniture-1", Label::furniture, "room-1");
    cupboard.kind = "cabinet";
    cupboard.box = OrientedBox{};
    cupboard.box->center = {4.5, 3.7, 0.45};
    cupboard.box->size = {0.8, 0.5, 0.9};
    Component drawer = make("furniture-2", Label::furniture, "furniture-1");
    drawer.kind = "drawer";
    drawer.polygon = upright({4.1, 3.45, 0.6}, 0.8, 0.2);
    Component handle = make("handle-1", Label::handle, "furniture-2");
    handle.kind = "bar_handle";
    handle.box = OrientedBox{};
    handle.box->center = {4.5, 3.43, 0.7};
    handle.box->size = {0.16, 0.03, 0.012};
    handle.grasp = Grasp{handle.box->center, {0, 0, 1}, {0, 1, 0}, 0.022};
    scene.components = {wall, door, frame, window, cupboard, drawer, handle};

    Room room;
    room.id = "room-1";
    room.polygon = {{0, 0, 0}, {5, 0, 0}, {5, 4, 0}, {0, 4, 0}};
    room.ceiling_height = 2.5;
    room.area = 20;
    room.volume = 50;
    room.walls = {"wall-1"};
    room.neighbors = {{"room-2", "door-1"}};
    Room next = room;
    next.id = "room-2";
    next.polygon = {{0, -4, 0}, {5, -4, 0}, {5, -0.2, 0}, {0, -0.2, 0}};
    next.walls.clear();
    next.neighbors = {{"room-1", "door-1"}};
    scene.rooms = {room, next};
    Transform map_from_room(Eigen::AngleAxisd(3.0, Eigen::Vector3d(1, 0.2, 0.1).normalized()));
    map_from_room.pretranslate(Eigen::Vector3d(10, 0, -3));
    return transformed_scene(scene, map_from_room);
}

/// Three scans in a map, a fourth and a fifth that are joined to each other alone, a sixth alone.
std::string small_registration() {
    Registration registration;
    registration.map_from_scan.resize(6);
    for (std::size_t i = 0; i < 3; ++i)
        registration.map_from_scan[i] = Transform::Identity();
    registration.is_doubtful = {false, false, true, false, false, false};
    registration.residuals = {0.004, 0.004, 0.009, 0.01, 0.01, std::nan("")};
    registration.overlaps = {0.6, 0.6, 0.3, 0.5, 0.5, 0.0};
    registration.covariances.resize(6, Eigen::Matrix<double, 6, 6>::Zero());
    registration.covariances[1].diagonal().setConstant(1e-6);
    registration.components = {{0, 1, 2}, {3, 4}, {5}};
    const auto link = [&](std::size_t source, std::size_t target, LinkVerdict verdict) {
        RegistrationLink& added = registration.links.emplace_back();
        added.source = source;
        added.target = target;
        added.verdict = verdict;
        added.overlap = 0.6;
        added.agreement = 0.97;
        added.rmse = 0.004;
        added.probability = verdict == LinkVerdict::accepted ? 0.99 : 0.4;
        return &added;
    };
    link(1, 0, LinkVerdict::accepted);
    Transform rival = Transform::Identity();
    rival.translation().x() = 2.0;
    link(2, 1, LinkVerdict::ambiguous)->rivals = {rival};
    link(4, 3, LinkVerdict::accepted);
    link(3, 0, LinkVerdict::rejected);
    link(4, 0, LinkVerdict::rejected)->loops = LoopCheck::disagrees;
    const std::vector<std::string> names{"000.ply", "001.ply", "002.ply",
                                         "003.ply", "004.ply", "005.ply"};
    return registration_to_json(registration, names);
}

class Explain : public testing::Test {
  protected:
    Explain() {
        std::ofstream(folder_ / "scene.json") << scene_to_json(small_scene());
        std::ofstream(folder_ / "registration.json") << small_registration();
    }
    ProgramResult explain(std::vector<std::string> ids) const {
        ids.insert(ids.begin(), {"explain", folder_.path().string()});
        return roomscribe(ids);
    }
    std::string text(const std::vector<std::string>& ids) const {
        const ProgramResult result = explain(ids);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return result.out;
    }
    nlohmann::json facts(const std::string& id) const {
        const auto list = nlohmann::json::parse(text({id, "--json"}));
        EXPECT_EQ(list.size(), 1U);
        return list.at(0);
    }

    TemporaryFolder folder_;
};

TEST_F(Explain, TellsOfADoorInWords) {
    EXPECT_EQ(text({"door-1"}),
              "door-1: door, 0.86 m wide, 2.03 m high\n"
              "  where    on wall-1 in room-1\n"
              "           down to the floor\n"
              "           1.00 m and 3.14 m from the ends of the wall\n"
              "           middle at x 1.43, y -0.10, z 1.01 m in the room frame\n"
              "  verdict  accepted, confidence 0.93\n"
              "  because  the rule of door-1\n"
              "  seen     84 % of it, 10 % hidden from every scanner\n"
              "  points   1000 from 3 scans\n"
              "  rival    none that fits what was seen\n"
              "  joins    room-1 and room-2\n"
              "  frame    door_frame-1\n");
}

TEST_F(Explain, TellsWhatSpeaksAgainstTheRivalReading) {
    EXPECT_THAT(text({"window-1"}),
                AllOf(HasSubstr("lower edge 0.90 m above the floor"),
                      HasSubstr("doubtful, confidence 0.61"),
                      HasSubstr("rival    niche\n           against it: the rule of window-1\n"
                                "           a scan of what is hidden would decide\n")));
    EXPECT_THAT(text({"wall-1"}), AllOf(HasSubstr("wall-1: wall, 5.00 m wide, 2.50 m high"),
                                        HasSubstr("residual  4.2 mm"),
                                        HasSubstr("carries   door-1, door_frame-1 and window-1")));
}

TEST_F(Explain, TellsOfFurnitureAndHandlesByTheirParents) {
    EXPECT_THAT(text({"furniture-1"}),
                AllOf(HasSubstr("cabinet (furniture), 0.80 m wide, 0.50 m deep, 0.90 m high"),
                      HasSubstr("carries  furniture-2")));
    EXPECT_THAT(text({"handle-1"}),
                AllOf(HasSubstr("bar handle (handle), 0.16 m wide, 30 mm deep, 12 mm high"),
                      HasSubstr("on furniture-2 of furniture-1 in room-1"),
                      HasSubstr("lower edge 0.69 m above the floor"),
                      HasSubstr("grasp    open the fingers 22 mm")));
    const auto handle = facts("handle-1");
    EXPECT_EQ(handle.at("parents"), nlohmann::json({"furniture-2", "furniture-1"}));
    EXPECT_EQ(handle.at("room"), "room-1");
    EXPECT_NEAR(handle.at("above_floor").get<double>(), 0.694, 1e-5);
    EXPECT_NEAR(handle.at("size").at("width").get<double>(), 0.16, 1e-6);
    EXPECT_EQ(handle.at("grasp").at("opening"), 0.022);
}

TEST_F(Explain, FindsTheRoomOfWhatHasNoParent) {
    Scene scene = small_scene();
    scene.components[4].parent = "";
    std::ofstream(folder_ / "scene.json") << scene_to_json(scene);
    EXPECT_EQ(facts("furniture-1").at("room"), "room-1");
    scene.components[4].parent = "nobody";
    scene.components[4].box->center += 20 * Eigen::Vector3d::UnitX();
    std::ofstream(folder_ / "scene.json") << scene_to_json(scene);
    EXPECT_FALSE(facts("furniture-1").contains("room"));
    EXPECT_THAT(text({"furniture-1"}), HasSubstr("part of nobody, which is not listed"));
}

TEST_F(Explain, TellsOfRooms) {
    EXPECT_THAT(text({"room-1"}), AllOf(HasSubstr("room-1: room, 20.00 m2, 2.50 m high, 50.0 m3"),
                                        HasSubstr("furniture-1 and furniture-2"),
                                        HasSubstr("handle-1"), HasSubstr("leads to   ")));
    const auto room = facts("room-1");
    EXPECT_EQ(room.at("neighbours").at(0).at("through"), "door-1");
    EXPECT_EQ(room.at("window"), nlohmann::json({"window-1"}));
    EXPECT_FALSE(facts("room-2").contains("window"));
}

TEST_F(Explain, TellsWhyAScanHasItsPlaceOrNone) {
    EXPECT_THAT(
        text({"001.ply"}),
        AllOf(HasSubstr("001.ply: scan, placed\n"), HasSubstr("by accepted links to 000.ply"),
              HasSubstr("residual     4.0 mm over its links"),
              HasSubstr("uncertainty  1.7 mm and 0.099 deg"),
              HasSubstr("accepted with 000.ply: 60 % overlap, 97 % of it agrees")));
    EXPECT_THAT(text({"002.ply"}),
                AllOf(HasSubstr("placed in doubt"), HasSubstr("ambiguous links to 001.ply"),
                      HasSubstr("another pose fits as well, 2.00 m and 0.0 deg away")));
    EXPECT_THAT(text({"003.ply"}),
                AllOf(HasSubstr("003.ply: scan, without a place\n"),
                      HasSubstr("none: joined to 004.ply alone, and no accepted or ambiguous link"),
                      HasSubstr("rejected with 000.ply"), HasSubstr("is not borne out")));
    EXPECT_THAT(text({"004.ply"}), HasSubstr("other ways between them lead elsewhere"));
    EXPECT_THAT(text({"005.ply"}), HasSubstr("no other scan looked enough like it"));
    EXPECT_EQ(facts("003.ply").at("placed"), false);
    EXPECT_EQ(facts("003.ply").at("links").size(), 2U);
}

TEST_F(Explain, ListsAllInALineEach) {
    const std::string out = text({});
    for (const char* id : {"room-1", "room-2", "door-1", "handle-1", "000.ply", "005.ply"})
        EXPECT_THAT(out, HasSubstr(std::string("\n") + id + " "));
    EXPECT_THAT(out, HasSubstr("on wall-1 in room-1; or niche"));
    EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 1 + 2 + 7 + 1 + 1 + 6);
    EXPECT_EQ(nlohmann::json::parse(text({"--json"})).size(), 2U + 7U + 6U);
    EXPECT_EQ(nlohmann::json::parse(text({"door-1", "001.ply", "--json"})).size(), 2U);
    // A registration alone.
    std::filesystem::remove(folder_ / "scene.json");
    EXPECT_THAT(text({}), AllOf(testing::StartsWith("scan "), Not(HasSubstr("door"))));
}

TEST_F(Explain, NamesTheNearestOfWhatIsNotThere) {
    expect_error(explain({"dor-1"}), 2, {"dor-1", "did you mean door-1 or "});
    expect_error(explain({"03.ply"}), 2, {"003.ply"});
    std::ofstream(folder_ / "scene.json") << "{";
    expect_error(explain({"door-1"}), 3, {"scene.json"});
}

TEST(ExplainScans, TellsOfWhatInterpretFound) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const std::string out = (folder / "out").string();
    ASSERT_EQ(roomscribe({"interpret", scan, "-o", out}).exit_code, 0);
    const auto all = nlohmann::json::parse(roomscribe({"explain", out, "--json"}).out);
    std::size_t num_components = 0;
    for (const auto& facts : all) {
        if (facts.at("label") == "room") continue;
        ++num_components;
        EXPECT_NE(facts.at("evidence").at("rule"), "") << facts;
        EXPECT_GT(facts.at("confidence"), 0.0) << facts;
        if (facts.at("verdict") == "doubtful") {
            EXPECT_TRUE(facts.at("evidence").contains("alternative")) << facts;
        }
        if (facts.at("evidence").at("points") > 0) {
            EXPECT_EQ(facts.at("evidence").at("scans"), 1) << facts;
        }
    }
    EXPECT_GT(num_components, 3U);
    // The scan itself still has its values told.
    EXPECT_THAT(roomscribe({"explain", scan}).out, HasSubstr("structure.point_spacing"));
}

}  // namespace
}  // namespace roomscribe::test
