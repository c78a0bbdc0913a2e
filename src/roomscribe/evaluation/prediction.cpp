// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/prediction.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>

namespace roomscribe {

std::optional<std::size_t> anchor_scan(const Prediction& prediction) {
    const auto& poses = prediction.map_from_scan;
    const auto placed =
        std::find_if(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); });
    if (placed == poses.end()) return std::nullopt;
    return static_cast<std::size_t>(placed - poses.begin());
}

Transform predicted_from_true_map(const GroundTruth& truth, const Prediction& prediction) {
    const std::optional<std::size_t> anchor = anchor_scan(prediction);
    if (!anchor) return Transform::Identity();
    return *prediction.map_from_scan[*anchor] * truth.map_from_scan.at(*anchor).inverse();
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
    }
    for (Room& room : scene.rooms)
        move(room.polygon);
    scene.room_from_map = scene.room_from_map * target_from_source.inverse();
    return scene;
}

std::vector<std::size_t> whole_of_component(const Scene& scene) {
    const std::vector<Component>& components = scene.components;
    std::unordered_map<std::string_view, std::size_t> furniture;
    for (std::size_t i = 0; i < components.size(); ++i) {
        if (components[i].label == Label::furniture) furniture.emplace(components[i].id, i);
    }
    std::vector<std::size_t> whole(components.size());
    for (std::size_t i = 0; i < components.size(); ++i) {
        whole[i] = i;
        if (components[i].label != Label::furniture) continue;
        // A chain of parents that bites its own tail ends after as many steps as there are pieces.
        for (std::size_t steps = 0; steps < furniture.size(); ++steps) {
            const auto parent = furniture.find(components[whole[i]].parent);
            if (parent == furniture.end()) break;
            whole[i] = parent->second;
        }
    }
    return whole;
}

}  // namespace roomscribe
