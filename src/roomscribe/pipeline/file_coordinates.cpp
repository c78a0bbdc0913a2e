// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/file_coordinates.hpp"

namespace roomscribe {

Transform in_file_coordinates(const Transform& target_from_source,
                              const Eigen::Vector3d& target_shift,
                              const Eigen::Vector3d& source_shift) {
    return Eigen::Translation3d(target_shift) * target_from_source *
           Eigen::Translation3d(-source_shift);
}

Scene in_file_coordinates(Scene scene, const Eigen::Vector3d& shift) {
    const auto move = [&shift](std::vector<Eigen::Vector3d>& polygon) {
        for (Eigen::Vector3d& corner : polygon)
            corner += shift;
    };
    for (Component& component : scene.components) {
        move(component.polygon);
        if (component.box) component.box->center += shift;
        if (component.grasp) component.grasp->position += shift;
    }
    for (Room& room : scene.rooms)
        move(room.polygon);
    scene.room_from_map = in_file_coordinates(scene.room_from_map, Eigen::Vector3d::Zero(), shift);
    return scene;
}

}  // namespace roomscribe
