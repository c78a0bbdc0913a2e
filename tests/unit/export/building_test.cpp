// SPDX-License-Identifier: MIT
#include "roomscribe/export/building.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/export/wall_openings.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "support/flat_of_two_rooms.hpp"

namespace roomscribe::test {
namespace {

const Wall& wall_with(const Building& building, const std::string& face_id) {
    for (const Wall& wall : building.walls) {
        for (const FaceInPlan& face : wall.faces)
            if (building.scene.components[face.component].id == face_id) return wall;
    }
    throw std::runtime_error("no wall has the face " + face_id);
}

const Opening& opening_of(const Building& building, const std::string& id) {
    for (const Opening& opening : building.openings)
        if (building.scene.components[opening.component()].id == id) return opening;
    throw std::runtime_error("no opening is of " + id);
}

TEST(DescribeBuilding, MakesOneWallOfTwoFacesBackToBack) {
    const Building building = describe_building(flat_of_two_rooms());
    EXPECT_EQ(building.walls.size(), 7U);
    const Wall& inner = wall_with(building, "wall-2");
    EXPECT_EQ(&inner, &wall_with(building, "wall-8"));
    EXPECT_EQ(inner.faces.size(), 2U);
    EXPECT_NEAR(inner.thickness, 0.12, 1e-9);
    EXPECT_EQ(inner.thickness_source, ThicknessSource::measured);
    EXPECT_NEAR(inner.start.x(), 4.06, 1e-9);
    EXPECT_NEAR(inner.end.x(), 4.06, 1e-9);
    EXPECT_EQ(wall_with(building, "wall-3").thickness_source, ThicknessSource::nominal);
    EXPECT_NEAR(wall_with(building, "wall-3").thickness, 0.1, 1e-9);
}

TEST(DescribeBuilding, KnowsALoneWallToBeAsThickAsItsWindowLiesDeep) {
    const Building building = describe_building(flat_of_two_rooms());
    const Wall& wall = wall_with(building, "wall-1");
    EXPECT_EQ(wall.thickness_source, ThicknessSource::openings);
    EXPECT_NEAR(wall.thickness, 0.2, 1e-9);
    // Its face stays where it was seen.
    EXPECT_NEAR(wall.start.y(), -0.1, 1e-9);
}

TEST(DescribeBuilding, PairsFacesWithinSixtyCentimetresOnly) {
    const auto count = [](double gap) {
        Scene scene = flat_of_two_rooms();
        scene = transformed_scene(scene, scene.room_from_map);
        scene.rooms[1].polygon[0].x() = 4.0 + gap;
        scene.rooms[1].polygon[3].x() = 4.0 + gap;
        for (Component& component : scene.components) {
            if (component.id != "wall-8") continue;
            for (Eigen::Vector3d& corner : component.polygon)
                corner.x() = 4.0 + gap;
        }
        return describe_building(scene).walls.size();
    };
    EXPECT_EQ(count(0.59), 7U);
    EXPECT_EQ(count(0.61), 8U);
}

TEST(DescribeBuilding, OpensTheWallByTheFrame) {
    const Building building = describe_building(flat_of_two_rooms());
    ASSERT_EQ(building.openings.size(), 2U);
    const Opening& door = opening_of(building, "door-1");
    EXPECT_EQ(&building.walls[door.wall], &wall_with(building, "wall-2"));
    EXPECT_NEAR(door.to - door.from, 0.9, 1e-9);
    EXPECT_NEAR(door.top - door.bottom, 2.05, 1e-9);
    ASSERT_TRUE(door.frame);
    const Opening& window = opening_of(building, "window-1");
    EXPECT_NEAR(window.to - window.from, 1.3, 1e-9);
    EXPECT_NEAR(window.bottom, 0.85, 1e-9);
    // Where it lies in the plan, whatever joins did to the wall's axis.
    const Wall& wall = building.walls[window.wall];
    const double x = (wall.start + 0.5 * (window.from + window.to) * wall.along()).x();
    EXPECT_NEAR(x, 2.0, 1e-9);
}

TEST(DescribeBuilding, FindsTheWallOfAnOpeningWithoutParent) {
    Scene scene = flat_of_two_rooms();
    for (Component& component : scene.components) {
        if (component.label == Label::door || component.label == Label::door_frame)
            component.parent = "";
    }
    const Building building = describe_building(scene);
    const Opening& door = opening_of(building, "door-1");
    EXPECT_EQ(&building.walls[door.wall], &wall_with(building, "wall-2"));
    EXPECT_TRUE(door.frame);
}

TEST(DescribeBuilding, LeavesOutWhatIsRejected) {
    Scene scene = flat_of_two_rooms();
    for (Component& component : scene.components) {
        if (component.id == "door-1") component.verdict = Verdict::rejected;
    }
    const Building building = describe_building(scene);
    EXPECT_EQ(building.scene.components.size() + 1, scene.components.size());
    EXPECT_FALSE(find_component(building.scene, "door-1"));
    EXPECT_EQ(building.room_of.size(), building.scene.components.size());
}

TEST(DescribeBuilding, TellsTheFloorBelowAlsoOutsideOfRooms) {
    Scene scene = transformed_scene(flat_of_two_rooms(), flat_of_two_rooms().room_from_map);
    for (Room& room : scene.rooms) {
        room.floor_height += 2.8;
        room.ceiling_height += 2.8;
    }
    Component& lost = scene.components.emplace_back(scene.components.front());
    lost.id = "lost";
    lost.parent = "";
    for (Eigen::Vector3d& corner : lost.polygon)
        corner += Eigen::Vector3d(100.0, 100.0, 2.8);
    const Building building = describe_building(scene);
    const std::size_t last = building.scene.components.size() - 1;
    ASSERT_FALSE(building.room_of[last]);
    EXPECT_DOUBLE_EQ(floor_below(building, last), 2.8);
}

TEST(DescribeBuilding, JoinsWallsSoThatBodiesFillTheCornersOnce) {
    const Building building = describe_building(flat_of_two_rooms());
    // Bodies cover the outer rectangle less the rooms: no gap at a corner, nothing twice.
    double body = 0.0;
    for (const Wall& wall : building.walls)
        body += (wall.body_to - wall.body_from) * wall.thickness;
    // 0.1 m around the rooms, and 0.1 m more below room-1, up to the inner wall.
    const double outer = (7.12 + 0.2) * (3 + 0.2) + 0.1 * (4.0 + 0.1);
    EXPECT_NEAR(body, outer - 12 - 9, 1e-9);
    const Wall& inner = wall_with(building, "wall-2");
    EXPECT_EQ(inner.joins.size(), 2U);
}

TEST(DescribeBuilding, PutsRoomsOfLevelFloorsIntoOneStorey) {
    Scene scene = flat_of_two_rooms();
    scene = transformed_scene(scene, scene.room_from_map);
    EXPECT_EQ(describe_building(scene).storeys.size(), 1U);
    scene.rooms[1].floor_height = 2.8;
    scene.rooms[1].ceiling_height = 5.3;
    const Building building = describe_building(scene);
    ASSERT_EQ(building.storeys.size(), 2U);
    EXPECT_EQ(building.storeys[0].elevation, 0.0);
    EXPECT_EQ(building.storeys[1].elevation, 2.8);
    EXPECT_EQ(building.storeys[1].rooms, std::vector<std::size_t>{1});
    EXPECT_EQ(building.walls.size(), 8U);
}

TEST(DescribeBuilding, HasAStoreyWhereNothingWasFound) {
    const Building building = describe_building({});
    EXPECT_EQ(building.storeys.size(), 1U);
    EXPECT_TRUE(building.walls.empty());
}

TEST(PiecesOfFace, LackTheOpenings) {
    const Building building = describe_building(flat_of_two_rooms());
    for (std::size_t i = 0; i < building.walls.size(); ++i) {
        for (std::size_t face = 0; face < building.walls[i].faces.size(); ++face) {
            const std::string& id =
                building.scene.components[building.walls[i].faces[face].component].id;
            double area = 0.0;
            for (const SpacePolygon& piece : pieces_of_face(building, i, face))
                area += area_vector(piece).norm();
            const double width = id == "wall-1" || id == "wall-3" ? 4.0 : 3.0;
            const double hole = id == "wall-1"                     ? 1.3 * 1.1
                                : id == "wall-2" || id == "wall-8" ? 0.9 * 2.05
                                                                   : 0.0;
            EXPECT_NEAR(area, 2.5 * width - hole, 1e-9) << id;
        }
    }
    EXPECT_NEAR(area_of_openings(building, opening_of(building, "door-1").wall), 0.9 * 2.05, 1e-9);
}

TEST(PiecesOfFrame, GoAroundTheLeaf) {
    const Building building = describe_building(flat_of_two_rooms());
    double area = 0.0;
    for (const SpacePolygon& piece : pieces_of_frame(building, opening_of(building, "door-1")))
        area += area_vector(piece).norm();
    EXPECT_NEAR(area, 0.9 * 2.05 - 0.8 * 2.0, 1e-9);
}

TEST(Sizes, AreAsPeopleSayThem) {
    const Building building = describe_building(flat_of_two_rooms());
    const auto& components = building.scene.components;
    const ComponentSize door = flat_size(components[*find_component(building.scene, "door-1")]);
    EXPECT_NEAR(door.width, 0.8, 1e-9);
    EXPECT_NEAR(door.height, 2.0, 1e-9);
    const BoxSize box = box_size(*components[*find_component(building.scene, "furniture-1")].box);
    EXPECT_NEAR(box.width, 0.8, 1e-9);
    EXPECT_NEAR(box.depth, 0.5, 1e-9);
    EXPECT_NEAR(box.height, 0.9, 1e-9);
}

}  // namespace
}  // namespace roomscribe::test
