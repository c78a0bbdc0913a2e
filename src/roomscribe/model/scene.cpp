// SPDX-License-Identifier: MIT
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

std::string_view verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::accepted:
            return "accepted";
        case Verdict::doubtful:
            return "doubtful";
        case Verdict::rejected:
            return "rejected";
    }
    return "";
}

std::string_view motion_kind_name(MotionKind kind) {
    return kind == MotionKind::hinged ? "hinged" : "pull";
}

Scene transformed_scene(Scene scene, const Transform& target_from_source) {
    const auto move = [&](std::vector<Eigen::Vector3d>& polygon) {
        for (Eigen::Vector3d& corner : polygon)
            corner = target_from_source * corner;
    };
    for (Component& component : scene.components) {
        move(component.polygon);
        if (component.box) {
            component.box->center = target_from_source * component.box->center;
            for (Eigen::Vector3d& axis : component.box->axes)
                axis = target_from_source.linear() * axis;
        }
        if (component.grasp) {
            component.grasp->position = target_from_source * component.grasp->position;
            component.grasp->axis = target_from_source.linear() * component.grasp->axis;
            component.grasp->approach = target_from_source.linear() * component.grasp->approach;
        }
        if (component.opens) {
            component.opens->point = target_from_source * component.opens->point;
            component.opens->direction = target_from_source.linear() * component.opens->direction;
        }
    }
    for (Room& room : scene.rooms)
        move(room.polygon);
    scene.room_from_map = scene.room_from_map * target_from_source.inverse();
    return scene;
}

}  // namespace roomscribe
