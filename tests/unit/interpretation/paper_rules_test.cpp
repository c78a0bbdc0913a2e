// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "roomscribe/interpretation/paper_rules/label_by_rules.hpp"
#include "roomscribe/interpretation/paper_rules/openings_by_rules.hpp"
#include "roomscribe/interpretation/paper_rules/orient_by_door.hpp"
#include "roomscribe/interpretation/paper_rules/plane_quadrilaterals.hpp"
#include "roomscribe/interpretation/paper_rules/room_by_pass_through.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr double step = 0.02;
constexpr double tolerance = 0.015;

/// Which places of a face, along its two sides, hold no points.
using Holes = std::vector<WallRectangle>;

/// Faces of a room, each a plane of its own.
struct Room {
    PointCloud cloud;
    std::vector<PlanarPatch> planes;

    void add_face(const Vector3d& corner, const Vector3d& u, const Vector3d& v,
                  const Holes& holes = {}) {
        std::vector<std::uint32_t> points;
        const Vector3d normal = u.cross(v).normalized();
        for (double a = 0.5 * step; a < u.norm(); a += step) {
            for (double b = 0.5 * step; b < v.norm(); b += step) {
                const auto holds = [&](const WallRectangle& hole) {
                    return a > hole.start && a < hole.end && b > hole.bottom && b < hole.top;
                };
                if (std::any_of(holes.begin(), holes.end(), holds)) continue;
                points.push_back(static_cast<std::uint32_t>(cloud.size()));
                const Vector3d place = corner + a * u.normalized() + b * v.normalized() +
                                       0.001 * random.normal() * normal;
                cloud.positions.push_back(place.cast<float>());
            }
        }
        planes.push_back(make_planar_patch(cloud, {normal, normal.dot(corner)}, points));
    }

    Random random{5};
};

struct RoomOptions {
    bool has_door = true;
    bool has_picture = false;
    bool has_ceiling = true;
    double sill = 1.8;
};

/// 5 x 4 x 3 m, floor at z = 0. In the wall y = 0 a door of 0.8 x 1.92 m over a threshold, 8 cm
/// deep in a hole that is 5 cm wider; in the wall x = 5 a window of 1.2 x 0.6 m whose pane returns
/// nothing; a picture of that size 5 cm before the wall y = 4.
Room make_room(const RoomOptions& options = {}) {
    Room room;
    const Vector3d x = 5.0 * Vector3d::UnitX();
    const Vector3d y = 4.0 * Vector3d::UnitY();
    const Vector3d z = 3.0 * Vector3d::UnitZ();
    room.add_face(Vector3d::Zero(), x, y);
    if (options.has_ceiling) room.add_face(z, x, y);
    room.add_face(Vector3d::Zero(), x, z,
                  options.has_door ? Holes{{1.0, 1.9, 0.06, 2.05}} : Holes{});
    room.add_face(y, x, z, options.has_picture ? Holes{{1.0, 2.2, 1.8, 2.4}} : Holes{});
    room.add_face(Vector3d::Zero(), y, z);
    room.add_face(x, y, z, Holes{{1.4, 2.6, options.sill, options.sill + 0.6}});
    if (options.has_door) {
        room.add_face({1.05, -0.08, 0.08}, 0.8 * Vector3d::UnitX(), 1.92 * Vector3d::UnitZ());
    }
    if (options.has_picture) {
        room.add_face({1.0, 3.95, 1.8}, 1.2 * Vector3d::UnitX(), 0.6 * Vector3d::UnitZ());
    }
    return room;
}

void turn(Room& room, const Transform& pose) {
    transform_in_place(room.cloud, pose);
    for (PlanarPatch& patch : room.planes)
        patch = make_planar_patch(room.cloud, patch.plane, patch.points);
}

std::vector<PlaneQuadrilateral> quadrilaterals_of(const Room& room) {
    return find_plane_quadrilaterals(room.cloud, room.planes, step, 1);
}

DoorOrientation orient(const Room& room, std::span<const PlaneQuadrilateral> quadrilaterals) {
    return orient_by_door(quadrilaterals, room.planes, principal_axes_of_planes(room.planes));
}

std::vector<const Component*> of_label(const Scene& scene, Label label) {
    std::vector<const Component*> found;
    for (const Component& component : scene.components) {
        if (component.label == label) found.push_back(&component);
    }
    return found;
}

/// Of a polygon in the room's own frame.
Eigen::AlignedBox3d box_of(const Component& component, const Transform& room_from_map) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& corner : component.polygon)
        box.extend(room_from_map * corner);
    return box;
}

std::vector<Transform> poses() {
    Random random(3);
    std::vector<Transform> poses(4, Transform::Identity());
    poses[1].linear() = Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
    poses[2] = test::random_transform(random);
    poses[3] = test::random_transform(random);
    return poses;
}

TEST(FindPlaneQuadrilaterals, AreWallsDoorHoleLeafAndWindow) {
    const Room room = make_room();
    const std::vector<PlaneQuadrilateral> quads = quadrilaterals_of(room);
    const auto has = [&](std::uint32_t plane, double a, double b) {
        return std::any_of(quads.begin(), quads.end(), [&](const PlaneQuadrilateral& quad) {
            const SideLengths sides = side_lengths(quad.quadrilateral);
            return quad.plane == plane &&
                   std::abs(std::max(sides.first, sides.second) - std::max(a, b)) < 0.05 &&
                   std::abs(std::min(sides.first, sides.second) - std::min(a, b)) < 0.05;
        });
    };
    EXPECT_TRUE(has(2, 5.0, 3.0));
    EXPECT_TRUE(has(2, 0.9, 1.99));
    EXPECT_TRUE(has(5, 1.2, 0.6));
    EXPECT_TRUE(has(6, 0.8, 1.92));
    EXPECT_TRUE(find_plane_quadrilaterals(room.cloud, room.planes, 0.0, 1).empty());
    EXPECT_TRUE(find_plane_quadrilaterals({}, {}, step, 1).empty());
}

TEST(OrientByDoor, PointsUpFromTheEdgeThatTheDoorStandsOn) {
    for (const Transform& pose : poses()) {
        Room room = make_room();
        turn(room, pose);
        const DoorOrientation found = orient(room, quadrilaterals_of(room));
        ASSERT_EQ(found.stop, DoorOrientationStop::door_found);
        EXPECT_GE(found.num_doors, 1U);
        EXPECT_GT(found.room_from_map.row(2).dot(pose.linear().col(2)), std::cos(0.01));
        EXPECT_GT(std::abs(found.room_from_map.row(1).dot(pose.linear().col(1))), std::cos(0.01));
        EXPECT_NEAR(found.room_from_map.determinant(), 1.0, 1e-9);
    }
}

TEST(OrientByDoor, SaysSoWhereNoDoorStands) {
    const Room room = make_room({.has_door = false});
    const DoorOrientation found = orient(room, quadrilaterals_of(room));
    EXPECT_EQ(found.stop, DoorOrientationStop::no_door);
    EXPECT_EQ(found.num_doors, 0U);
    EXPECT_EQ(found.room_from_map, Eigen::Matrix3d::Identity());
    EXPECT_EQ(orient_by_door({}, {}, {}).stop, DoorOrientationStop::no_door);
}

TEST(OrientByDoor, ADoorAsHighAsItsWallSaysNothing) {
    Room room;
    room.add_face(Vector3d::Zero(), 5.0 * Vector3d::UnitX(), 2.0 * Vector3d::UnitZ());
    room.add_face({1, -0.05, 0}, 0.8 * Vector3d::UnitX(), 2.0 * Vector3d::UnitZ());
    EXPECT_EQ(orient(room, quadrilaterals_of(room)).stop, DoorOrientationStop::no_door);
}

TEST(FindRoomByPassThrough, FloorCeilingAndWallsOfABox) {
    const Room room = make_room();
    const RuleRoom found =
        find_room_by_pass_through(room.cloud, room.planes, Eigen::Matrix3d::Identity());
    EXPECT_EQ(found.floor, std::vector<std::uint32_t>{0});
    EXPECT_EQ(found.ceiling, std::vector<std::uint32_t>{1});
    ASSERT_EQ(found.walls.size(), 4U);  // the leaf is none
    EXPECT_NEAR(*found.floor_height, 0.0, 0.002);
    EXPECT_NEAR(*found.ceiling_height, 3.0, 0.002);
    for (const RuleWall& wall : found.walls) {
        EXPECT_GT(wall.face.signed_distance({2.5, 2.0, 1.5}), 0.0);
        EXPECT_NEAR(wall.extent.height(), 3.0, 0.01);
        EXPECT_NEAR(wall.extent.width(), wall.plane < 4 ? 5.0 : 4.0, 0.15);
    }
    EXPECT_TRUE(find_room_by_pass_through({}, {}, Eigen::Matrix3d::Identity()).walls.empty());
}

TEST(FindRoomByPassThrough, WithoutCeilingWallsAreWhatIsAsHighAsOne) {
    const Room room = make_room({.has_ceiling = false});
    const RuleRoom found =
        find_room_by_pass_through(room.cloud, room.planes, Eigen::Matrix3d::Identity());
    EXPECT_TRUE(found.ceiling.empty());
    EXPECT_FALSE(found.ceiling_height);
    EXPECT_EQ(found.walls.size(), 4U);
}

TEST(FindRoomByPassThrough, ATableIsNoFloorAndASlantedPlaneNoWall) {
    Room room = make_room();
    room.add_face({1, 1, 0.7}, 2.0 * Vector3d::UnitX(), Vector3d::UnitY());
    room.add_face({1, 1, 0}, Vector3d(1, 1, 0), 3.0 * Vector3d::UnitZ());
    const RuleRoom found =
        find_room_by_pass_through(room.cloud, room.planes, Eigen::Matrix3d::Identity());
    EXPECT_EQ(found.floor.size(), 1U);
    EXPECT_EQ(found.walls.size(), 4U);
}

TEST(LabelByRules, FindsTheDoorTheWindowAndTheFrameInAnyPose) {
    for (const Transform& pose : poses()) {
        Room room = make_room({.has_picture = true});
        turn(room, pose);
        const std::vector<PlaneQuadrilateral> quads = quadrilaterals_of(room);
        const DoorOrientation orientation = orient(room, quads);
        const RuleLabels found =
            label_by_rules(room.cloud, room.planes, quads, orientation.room_from_map, tolerance);
        const Transform room_from_map = pose.inverse();
        EXPECT_EQ(of_label(found.scene, Label::floor).size(), 1U);
        EXPECT_EQ(of_label(found.scene, Label::ceiling).size(), 1U);
        EXPECT_EQ(of_label(found.scene, Label::wall).size(), 4U);
        const auto doors = of_label(found.scene, Label::door);
        const auto frames = of_label(found.scene, Label::door_frame);
        const auto windows = of_label(found.scene, Label::window);
        ASSERT_EQ(doors.size(), 1U);
        ASSERT_EQ(frames.size(), 1U);
        ASSERT_EQ(windows.size(), 1U);  // and not the picture
        const Eigen::AlignedBox3d door = box_of(*doors[0], room_from_map);
        EXPECT_LT((door.min() - Vector3d(1.05, -0.08, 0.08)).norm(), 0.05);
        EXPECT_LT((door.max() - Vector3d(1.85, -0.08, 2.0)).norm(), 0.05);
        const Eigen::AlignedBox3d frame = box_of(*frames[0], room_from_map);
        EXPECT_LT((frame.max() - Vector3d(1.9, 0.0, 2.05)).norm(), 0.05);
        const Eigen::AlignedBox3d window = box_of(*windows[0], room_from_map);
        EXPECT_LT((window.min() - Vector3d(5.0, 1.4, 1.8)).norm(), 0.05);
        EXPECT_LT((window.max() - Vector3d(5.0, 2.6, 2.4)).norm(), 0.05);
        EXPECT_FALSE(doors[0]->parent.empty());
        EXPECT_EQ(doors[0]->parent, frames[0]->parent);
    }
}

TEST(LabelByRules, EveryPointOfAPlaneHasItsLabel) {
    const Room room = make_room();
    const std::vector<PlaneQuadrilateral> quads = quadrilaterals_of(room);
    const RuleLabels found =
        label_by_rules(room.cloud, room.planes, quads, Eigen::Matrix3d::Identity(), tolerance);
    ASSERT_EQ(found.labels.labels.size(), room.cloud.size());
    const std::array<Label, 7> expected{Label::floor, Label::ceiling, Label::wall, Label::wall,
                                        Label::wall,  Label::wall,    Label::door};
    for (std::size_t plane = 0; plane < room.planes.size(); ++plane) {
        std::size_t num_right = 0;
        for (const std::uint32_t point : room.planes[plane].points) {
            const Label label = found.labels.labels[point];
            num_right += label == expected[plane] ? 1 : 0;
            ASSERT_NE(label, Label::unknown);
            ASSERT_GE(found.labels.instances[point], 0);
            const Component& component =
                found.scene.components[static_cast<std::size_t>(found.labels.instances[point])];
            ASSERT_EQ(component.label, label);
        }
        EXPECT_GT(static_cast<double>(num_right),
                  0.95 * static_cast<double>(room.planes[plane].points.size()))
            << plane;
    }
    const Vector3d corner = found.scene.room_from_map * Vector3d(0, 0, 0);
    EXPECT_LT(corner.norm(), 0.12);
}

TEST(LabelByRules, AWindowIsNearerToTheCeilingThanToTheFloor) {
    const Room room = make_room({.sill = 0.5});
    const RuleLabels found = label_by_rules(room.cloud, room.planes, quadrilaterals_of(room),
                                            Eigen::Matrix3d::Identity(), tolerance);
    EXPECT_TRUE(of_label(found.scene, Label::window).empty());
    EXPECT_EQ(of_label(found.scene, Label::door).size(), 1U);
}

TEST(LabelByRules, SizesAreSettings) {
    const Room room = make_room();
    PaperRulesSettings settings;
    settings.door_height = 1.2;
    settings.window_width = 3.0;
    const RuleLabels found = label_by_rules(room.cloud, room.planes, quadrilaterals_of(room),
                                            Eigen::Matrix3d::Identity(), tolerance, settings);
    EXPECT_TRUE(of_label(found.scene, Label::door).empty());
    EXPECT_TRUE(of_label(found.scene, Label::window).empty());
}

TEST(LabelByRules, NothingIsUnknown) {
    PointCloud cloud;
    cloud.positions.assign(10, Eigen::Vector3f::Zero());
    const RuleLabels found = label_by_rules(cloud, {}, {}, Eigen::Matrix3d::Identity(), tolerance);
    EXPECT_TRUE(found.scene.components.empty());
    EXPECT_EQ(std::count(found.labels.labels.begin(), found.labels.labels.end(), Label::unknown),
              10);
}

}  // namespace
}  // namespace roomscribe
