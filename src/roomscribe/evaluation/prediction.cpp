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
        std::size_t end = i;
        std::size_t steps = 0;
        for (auto parent = furniture.find(components[end].parent);
             parent != furniture.end() && steps <= furniture.size();
             parent = furniture.find(components[end].parent), ++steps) {
            end = parent->second;
        }
        // A chain that bites its own tail has no end: each link counts for itself.
        if (steps <= furniture.size()) whole[i] = end;
    }
    return whole;
}

}  // namespace roomscribe
