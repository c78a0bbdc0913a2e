// SPDX-License-Identifier: MIT
// What is written of a building, read back by small readers of the formats.
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "roomscribe/export/floor_plan_dxf.hpp"
#include "roomscribe/export/floor_plan_svg.hpp"
#include "roomscribe/export/gltf.hpp"
#include "roomscribe/export/ifc.hpp"
#include "roomscribe/export/scene_graph.hpp"
#include "roomscribe/export/schedules.hpp"
#include "support/flat_of_two_rooms.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

Building flat() {
    return describe_building(flat_of_two_rooms());
}

std::size_t count(const std::string& text, const std::string& words) {
    std::size_t number = 0;
    for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
        ++number;
    return number;
}

struct Glb {
    Json json;
    std::string buffer;
};

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

Glb parse_glb(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(number_at(bytes, 4), 2U);
    EXPECT_EQ(number_at(bytes, 8), bytes.size());
    const std::size_t length = number_at(bytes, 12);
    EXPECT_EQ(length % 4, 0U);
    Glb glb{Json::parse(bytes.substr(20, length)), ""};
    if (20 + length < bytes.size()) glb.buffer = bytes.substr(28 + length);
    return glb;
}

/// m2 of all triangles of a node.
double area_of(const Glb& glb, const std::string& name) {
    for (const Json& node : glb.json.at("nodes")) {
        if (node.at("name") != name) continue;
        const Json& primitive =
            glb.json.at("meshes")[node.at("mesh").get<std::size_t>()]["primitives"][0];
        const auto data = [&](const Json& index) {
            const Json& accessor = glb.json["accessors"][index.get<std::size_t>()];
            const Json& view = glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
            return view["byteOffset"].get<std::size_t>() +
                   accessor["byteOffset"].get<std::size_t>();
        };
        const std::size_t positions = data(primitive["attributes"]["POSITION"]);
        const std::size_t indices = data(primitive["indices"]);
        const auto num_indices =
            glb.json["accessors"][primitive["indices"].get<std::size_t>()]["count"]
                .get<std::size_t>();
        const auto corner = [&](std::size_t i) {
            std::array<float, 3> p{};
            const std::size_t index = number_at(glb.buffer, indices + 4 * i);
            std::memcpy(p.data(), glb.buffer.data() + positions + 12 * index, 12);
            return Eigen::Vector3d(p[0], p[1], p[2]);
        };
        double area = 0.0;
        for (std::size_t i = 0; i < num_indices; i += 3)
            area += 0.5 * (corner(i + 1) - corner(i)).cross(corner(i + 2) - corner(i)).norm();
        return area;
    }
    ADD_FAILURE() << "no node " << name;
    return 0.0;
}

TEST(Gltf, HasAnAreaPerNodeAsTheSceneHas) {
    const Glb glb = parse_glb(building_to_glb(flat()));
    EXPECT_NEAR(area_of(glb, "wall-1"), 4 * 2.5 - 1.3 * 1.1, 1e-5);
    EXPECT_NEAR(area_of(glb, "wall-2"), 3 * 2.5 - 0.9 * 2.05, 1e-5);
    EXPECT_NEAR(area_of(glb, "wall-8"), 3 * 2.5 - 0.9 * 2.05, 1e-5);
    EXPECT_NEAR(area_of(glb, "floor-2"), 9, 1e-5);
    EXPECT_NEAR(area_of(glb, "door-1"), 1.6, 1e-5);
    EXPECT_NEAR(area_of(glb, "door_frame-1"), 0.9 * 2.05 - 1.6, 1e-5);
    EXPECT_NEAR(area_of(glb, "furniture-1"), 2 * (0.8 * 0.5 + 0.8 * 0.9 + 0.5 * 0.9), 1e-5);
    EXPECT_NEAR(area_of(glb, "furniture-2"), 0.16, 1e-5);
}

TEST(Gltf, HangsComponentsBelowTheirRoomsWithYUp) {
    const Glb glb = parse_glb(building_to_glb(flat()));
    std::map<std::string, std::string> parent;
    const Json& nodes = glb.json["nodes"];
    for (const Json& node : nodes) {
        for (const Json& child : node.value("children", Json::array()))
            parent[nodes[child.get<std::size_t>()]["name"]] = node["name"];
    }
    EXPECT_EQ(parent["storey-1"], "building");
    EXPECT_EQ(parent["room-2"], "storey-1");
    EXPECT_EQ(parent["wall-5"], "room-2");
    EXPECT_EQ(parent["handle-1"], "room-1");
    std::set<std::string> materials;
    for (const Json& material : glb.json["materials"])
        materials.insert(material["name"]);
    EXPECT_THAT(materials, testing::IsSupersetOf({"wall", "door", "window", "handle"}));
    float top = 0.0F;
    for (const Json& accessor : glb.json["accessors"])
        if (accessor["type"] == "VEC3") top = std::max(top, accessor["max"][1].get<float>());
    EXPECT_EQ(top, 2.5F);
}

TEST(Gltf, OfNothingIsValid) {
    const Glb glb = parse_glb(building_to_glb(describe_building({})));
    EXPECT_FALSE(glb.json.contains("buffers"));
    EXPECT_FALSE(glb.json.contains("meshes"));
}

TEST(Ifc, HasAllElementsAndRelations) {
    const std::string ifc = building_to_ifc(flat(), {"flat.ifc", "2026-01-01T00:00:00", "1"});
    EXPECT_THAT(ifc, testing::StartsWith("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION"));
    EXPECT_THAT(ifc, HasSubstr("FILE_SCHEMA(('IFC4'));"));
    EXPECT_EQ(count(ifc, "=IFCWALL("), 7U);
    EXPECT_EQ(count(ifc, "=IFCDOOR("), 1U);
    EXPECT_EQ(count(ifc, "=IFCWINDOW("), 1U);
    EXPECT_EQ(count(ifc, "=IFCSPACE("), 2U);
    EXPECT_EQ(count(ifc, "=IFCSLAB("), 2U);
    EXPECT_EQ(count(ifc, "=IFCCOVERING("), 2U);
    EXPECT_EQ(count(ifc, "=IFCOPENINGELEMENT("), 2U);
    EXPECT_EQ(count(ifc, "=IFCRELVOIDSELEMENT("), 2U);
    EXPECT_EQ(count(ifc, "=IFCRELFILLSELEMENT("), 2U);
    EXPECT_EQ(count(ifc, "=IFCFURNITURE("), 1U);
    EXPECT_GE(count(ifc, "=IFCRELCONNECTSPATHELEMENTS("), 6U);
    // Door and window end with their overall height and width.
    EXPECT_THAT(ifc, HasSubstr(",'door-1',2.,0.8,.DOOR."));
    EXPECT_THAT(ifc, HasSubstr(",'window-1',1.,1.2,.WINDOW."));
    EXPECT_THAT(ifc, HasSubstr("IFCQUANTITYAREA('NetFloorArea',$,$,12.,$)"));
    EXPECT_THAT(ifc, HasSubstr("IFCQUANTITYVOLUME('NetVolume',$,$,22.5,$)"));
    EXPECT_THAT(ifc, HasSubstr("IFCLABEL('doubtful')"));
}

TEST(Ifc, RefersBackwardsOnlyAndNamesEverythingOnce) {
    const std::string ifc = building_to_ifc(flat());
    std::istringstream lines(ifc);
    std::set<std::string> global_ids;
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] != '#') continue;
        EXPECT_THAT(line, testing::StartsWith("#" + std::to_string(++number) + "="));
        static const std::regex text("'([^']|'')*'");
        static const std::regex reference("#([0-9]+)");
        const std::string bare = std::regex_replace(line.substr(line.find('=')), text, "");
        for (std::sregex_iterator it(bare.begin(), bare.end(), reference), end; it != end; ++it)
            EXPECT_LT(std::stoul((*it)[1]), number) << line;
        static const std::regex root(R"(\('([0-9A-Za-z_$]{22})',\$)");
        if (std::smatch found; std::regex_search(line, found, root)) {
            EXPECT_TRUE(global_ids.insert(found[1]).second) << line;
        }
    }
    EXPECT_GT(global_ids.size(), 30U);
    EXPECT_EQ(building_to_ifc(flat()), ifc);
}

TEST(Ifc, KeepsADoorWithoutAWall) {
    Scene scene = flat_of_two_rooms();
    std::erase_if(scene.components, [](const Component& c) { return c.label == Label::wall; });
    const std::string ifc = building_to_ifc(describe_building(scene));
    EXPECT_EQ(count(ifc, "=IFCWALL("), 0U);
    EXPECT_EQ(count(ifc, "=IFCDOOR("), 1U);
    EXPECT_EQ(count(ifc, "=IFCOPENINGELEMENT("), 0U);
}

/// Entities of a DXF, each with its groups.
std::vector<std::multimap<int, std::string>> parse_dxf(const std::string& text) {
    std::istringstream lines(text);
    std::vector<std::multimap<int, std::string>> entities;
    std::string code;
    std::string value;
    bool in_entities = false;
    while (std::getline(lines, code) && std::getline(lines, value)) {
        const int group = std::stoi(code);
        if (group == 2 && value == "ENTITIES") in_entities = true;
        if (!in_entities) continue;
        if (group == 0) entities.emplace_back();
        if (!entities.empty()) entities.back().emplace(group, value);
    }
    return entities;
}

TEST(Dxf, HasItsLayersInMetres) {
    const std::string dxf = plans_to_dxf(draw_floor_plans(flat()));
    EXPECT_THAT(dxf, HasSubstr("$INSUNITS\n 70\n6\n"));
    EXPECT_THAT(dxf, testing::EndsWith("  0\nEOF\n"));
    std::map<std::string, int> per_layer;
    std::vector<double> room_x;
    double arc_radius = 0.0;
    for (const auto& entity : parse_dxf(dxf)) {
        const auto get = [&](int code) {
            const auto found = entity.find(code);
            return found == entity.end() ? std::string() : found->second;
        };
        if (entity.contains(8)) ++per_layer[get(8)];
        if (get(0) == "VERTEX" && get(8) == "ROOMS") room_x.push_back(std::stod(get(10)));
        if (get(0) == "ARC") {
            arc_radius = std::stod(get(40));
            EXPECT_NEAR(std::stod(get(51)) - std::stod(get(50)), 90.0, 1e-4);
        }
    }
    for (const auto& name : plan_layer_names)
        EXPECT_GT(per_layer[std::string(name)], 0) << name;
    EXPECT_NEAR(*std::min_element(room_x.begin(), room_x.end()), 0.0, 1e-6);
    EXPECT_NEAR(*std::max_element(room_x.begin(), room_x.end()), 7.12, 1e-6);
    EXPECT_NEAR(arc_radius, 0.8, 1e-6);
}

TEST(StoreyPlan, DrawsWallsWithGapsAndTheSizesOfRooms) {
    const std::vector<StoreyPlan> plans = draw_floor_plans(flat());
    ASSERT_EQ(plans.size(), 1U);
    double length = 0.0;
    std::map<std::string, double> faces;
    for (const PlanPath& path : plans[0].paths) {
        if (path.layer == PlanLayer::faces)
            faces[path.id] += (path.corners.at(1) - path.corners.at(0)).norm();
        if (path.layer != PlanLayer::walls || (path.id != "wall-2" && path.id != "wall-8"))
            continue;
        ASSERT_EQ(path.corners.size(), 4U);
        length += (path.corners[1] - path.corners[0]).norm();
        EXPECT_NEAR((path.corners[2] - path.corners[1]).norm(), 0.12, 1e-9);
    }
    EXPECT_NEAR(length, 3.0 + 0.1 + 0.1 - 0.9, 1e-9);
    EXPECT_EQ(faces.size(), 8U);
    EXPECT_NEAR(faces["wall-1"], 4.0, 1e-9);
    EXPECT_NEAR(faces["wall-8"], 3.0, 1e-9);
    std::multiset<std::string> words;
    for (const PlanText& text : plans[0].texts)
        words.insert(text.text);
    EXPECT_THAT(words, testing::IsSupersetOf({"room-1", "12.00 m\u00b2", "room-2", "9.00 m\u00b2",
                                              "4.00", "3.00", "cabinet"}));
    EXPECT_EQ(words.count("3.00"), 3U);
}

TEST(StoreyPlan, DrawsTwoLeavesInAWideDoorway) {
    Scene scene = flat_of_two_rooms();
    scene = transformed_scene(scene, scene.room_from_map);
    for (Component& component : scene.components) {
        if (component.id == "door-1")
            component.polygon = upright_rectangle({4.06, 1.05, 0}, {0, 1.4, 0}, 2.0);
    }
    const StoreyPlan plan = draw_floor_plans(describe_building(scene)).front();
    ASSERT_EQ(plan.arcs.size(), 2U);
    for (const PlanArc& arc : plan.arcs) {
        EXPECT_NEAR(arc.radius, 0.7, 1e-9);
        EXPECT_NEAR(arc.to - arc.from, std::numbers::pi / 2, 1e-9);
        // Both open towards the same room: the hinge turns to the left of the way along y.
        const double middle = 0.5 * (arc.from + arc.to);
        EXPECT_LT(std::cos(middle), 0.0);
    }
}

TEST(StoreyPlan, DrawsWhatLiesInNoWallAsWideAsItIs) {
    Scene scene = flat_of_two_rooms();
    std::erase_if(scene.components, [](const Component& c) { return c.label == Label::wall; });
    const StoreyPlan plan = draw_floor_plans(describe_building(scene)).front();
    ASSERT_EQ(plan.arcs.size(), 1U);
    EXPECT_EQ(plan.arcs[0].id, "door-1");
    EXPECT_NEAR(plan.arcs[0].radius, 0.8, 1e-9);
    int num_panes = 0;
    for (const PlanPath& path : plan.paths) {
        if (path.layer != PlanLayer::windows) continue;
        ++num_panes;
        EXPECT_NEAR((path.corners.at(1) - path.corners.at(0)).norm(), 1.2, 1e-9);
    }
    EXPECT_EQ(num_panes, 2);
}

TEST(Svg, IsAtOneToFifty) {
    const std::string svg = plans_to_svg(draw_floor_plans(flat()));
    const std::regex room(
        "<path d=\"M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)[^\"]*\" "
        "data-id=\"room-1\"/>");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(svg, found, room));
    EXPECT_NEAR(std::hypot(std::stod(found[3]) - std::stod(found[1]),
                           std::stod(found[4]) - std::stod(found[2])),
                4000.0 / 50, 0.01);
    const std::regex size(
        "width=\"([0-9.]+)mm\" height=\"([0-9.]+)mm\" viewBox=\"0 0 ([0-9.]+) "
        "([0-9.]+)\"");
    ASSERT_TRUE(std::regex_search(svg, found, size));
    EXPECT_EQ(found[1], found[3]);
    EXPECT_EQ(found[2], found[4]);
    EXPECT_EQ(count(svg, "<g"), count(svg, "</g>"));
}

TEST(Schedules, HaveARowAThing) {
    std::map<std::string, std::string> files;
    for (const Schedule& schedule : building_to_schedules(flat()))
        files[schedule.file_name] = schedule.csv;
    EXPECT_EQ(files.size(), 6U);
    EXPECT_EQ(count(files["walls.csv"], "\r\n"), 1U + 8U);
    EXPECT_EQ(count(files["rooms.csv"], "\r\n"), 1U + 2U);
    EXPECT_EQ(count(files["furniture.csv"], "\r\n"), 1U + 2U);
    EXPECT_THAT(files["doors.csv"],
                HasSubstr("door-1,,wall-2,room-1,0.8000,2.0000,1.6000,0.0000,door_frame-1,0.9000,"
                          "2.0500,hinged,0.9000,accepted,\r\n"));
    EXPECT_THAT(files["windows.csv"], HasSubstr(",doubtful,\"a picture, \"\"framed\"\"\"\r\n"));
    EXPECT_THAT(files["walls.csv"],
                HasSubstr("wall-2,room-1,3.0000,2.5000,7.5000,5.6550,0.1200,measured,wall-8,"));
    EXPECT_THAT(files["handles.csv"],
                HasSubstr("handle-1,bar_handle,furniture-2,room-1,0.1600,0.0300,0.0120,0.6000,"
                          "2.4300,0.7000,0.0000,0.0000,1.0000,0.0000,1.0000,0.0000,0.0220,,"));
    // Every row has as many cells as the heading, quotes aside.
    for (const auto& [name, csv] : files) {
        std::istringstream lines(csv);
        std::string heading;
        std::getline(lines, heading);
        for (std::string line; std::getline(lines, line);) {
            const std::string bare = std::regex_replace(line, std::regex("\"([^\"]|\"\")*\""), "");
            EXPECT_EQ(count(bare, ","), count(heading, ",")) << name << ": " << line;
        }
    }
}

TEST(Ifc, HasOneHoleInADoorwayWhoseDoorIsGone) {
    Scene scene = flat_of_two_rooms();
    for (Component& component : scene.components) {
        if (component.id != "door-1") continue;
        component.label = Label::unknown;
        component.kind = "opening";
    }
    const Building building = describe_building(scene);
    EXPECT_EQ(building.openings.size(), 2U);
    const std::string ifc = building_to_ifc(building);
    EXPECT_EQ(count(ifc, "=IFCOPENINGELEMENT("), 2U);
    EXPECT_EQ(count(ifc, "=IFCDOOR("), 0U);
    EXPECT_NEAR(area_of(parse_glb(building_to_glb(building)), "door_frame-1"), 0.9 * 2.05 - 1.6,
                1e-5);
}

TEST(SceneGraph, RunsFromStoreyToHandle) {
    const Json graph = Json::parse(building_to_graph(flat()));
    std::map<std::string, std::string> holder;
    std::set<std::string> leads;
    for (const Json& edge : graph["edges"]) {
        if (edge["relation"] == "contains") {
            EXPECT_TRUE(holder.emplace(edge["to"], edge["from"]).second) << edge;
        }
        if (edge["relation"] == "leads_to")
            leads.insert(edge["from"].get<std::string>() + ">" + edge["to"].get<std::string>() +
                         " " + edge["through"].get<std::string>());
    }
    EXPECT_EQ(holder["room-1"], "storey-1");
    EXPECT_EQ(holder["wall-2"], "room-1");
    EXPECT_EQ(holder["door-1"], "wall-2");
    EXPECT_EQ(holder["furniture-1"], "room-1");
    EXPECT_EQ(holder["furniture-2"], "furniture-1");
    EXPECT_EQ(holder["handle-1"], "furniture-2");
    EXPECT_THAT(leads, testing::ElementsAre("room-1>room-2 door-1", "room-2>room-1 door-1"));
    EXPECT_EQ(graph["nodes"].size(), 1U + 2U + flat().scene.components.size());
    EXPECT_EQ(holder.size(), graph["nodes"].size() - 1);
}

}  // namespace
}  // namespace roomscribe::test
