// SPDX-License-Identifier: MIT
#include "support/flat_of_two_rooms.hpp"

#include <Eigen/Geometry>

namespace roomscribe::test {
namespace {

constexpr double room_height = 2.5;

Component make(const std::string& id, Label label, const std::string& parent) {
    Component component;
    component.id = id;
    component.label = label;
    component.parent = parent;
    component.confidence = 0.9;
    component.verdict = Verdict::accepted;
    component.evidence.rule = "the rule of " + id;
    return component;
}

Component flat(const std::string& id, Label label, const std::string& parent,
               std::vector<Eigen::Vector3d> polygon) {
    Component component = make(id, label, parent);
    component.polygon = std::move(polygon);
    return component;
}

void add_room(Scene& scene, int number, double from, double to) {
    const std::string suffix = std::to_string(number);
    Room room;
    room.id = "room-" + suffix;
    room.polygon = {{from, 0, 0}, {to, 0, 0}, {to, 3, 0}, {from, 3, 0}};
    room.ceiling_height = room_height;
    room.area = 3 * (to - from);
    room.volume = room_height * room.area;
    scene.components.push_back(flat("floor-" + suffix, Label::floor, room.id, room.polygon));
    std::vector<Eigen::Vector3d> ceiling = room.polygon;
    for (Eigen::Vector3d& corner : ceiling)
        corner.z() = room_height;
    scene.components.push_back(flat("ceiling-" + suffix, Label::ceiling, room.id, ceiling));
    for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector3d along = room.polygon[(i + 1) % 4] - room.polygon[i];
        const std::string id = "wall-" + std::to_string(4 * (number - 1) + static_cast<int>(i) + 1);
        scene.components.push_back(
            flat(id, Label::wall, room.id, upright_rectangle(room.polygon[i], along, room_height)));
        room.walls.push_back(id);
    }
    room.neighbors = {{number == 1 ? "room-2" : "room-1", "door-1"}};
    scene.rooms.push_back(room);
}

void add_cabinet(Scene& scene) {
    Component cabinet = make("furniture-1", Label::furniture, "room-1");
    cabinet.kind = "cabinet";
    cabinet.box = OrientedBox{};
    cabinet.box->center = {0.6, 2.7, 0.45};
    cabinet.box->size = {0.8, 0.5, 0.9};
    Component drawer = flat("furniture-2", Label::furniture, "furniture-1",
                            upright_rectangle({0.2, 2.45, 0.6}, {0.8, 0, 0}, 0.2));
    drawer.kind = "drawer";
    Component handle = make("handle-1", Label::handle, "furniture-2");
    handle.kind = "bar_handle";
    handle.box = OrientedBox{};
    handle.box->center = {0.6, 2.43, 0.7};
    handle.box->size = {0.16, 0.03, 0.012};
    handle.grasp = Grasp{handle.box->center, {0, 0, 1}, {0, 1, 0}, 0.022};
    scene.components.insert(scene.components.end(), {cabinet, drawer, handle});
}

}  // namespace

std::vector<Eigen::Vector3d> upright_rectangle(const Eigen::Vector3d& corner,
                                               const Eigen::Vector3d& along, double height) {
    const Eigen::Vector3d up(0, 0, height);
    return {corner, corner + along, corner + along + up, corner + up};
}

Scene flat_of_two_rooms() {
    Scene scene;
    add_room(scene, 1, 0.0, 4.0);
    add_room(scene, 2, 4.12, 7.12);
    Component door =
        flat("door-1", Label::door, "wall-2", upright_rectangle({4.06, 1.05, 0}, {0, 0.8, 0}, 2.0));
    door.opens = OpeningMotion{MotionKind::hinged, {4.06, 1.05, 1}, {0, 0, 1}, 0.9};
    scene.components.push_back(door);
    scene.components.push_back(flat("door_frame-1", Label::door_frame, "wall-2",
                                    upright_rectangle({4.0, 1.0, 0}, {0, 0.9, 0}, 2.05)));
    Component window = flat("window-1", Label::window, "wall-1",
                            upright_rectangle({1.4, -0.2, 0.9}, {1.2, 0, 0}, 1.0));
    window.verdict = Verdict::doubtful;
    window.evidence.alternative = "a picture, \"framed\"";
    scene.components.push_back(window);
    scene.components.push_back(flat("window_frame-1", Label::window_frame, "wall-1",
                                    upright_rectangle({1.35, -0.2, 0.85}, {1.3, 0, 0}, 1.1)));
    add_cabinet(scene);
    Transform map_from_room(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 0.2, 0.1).normalized()));
    map_from_room.pretranslate(Eigen::Vector3d(10, 0, -3));
    return transformed_scene(scene, map_from_room);
}

}  // namespace roomscribe::test
