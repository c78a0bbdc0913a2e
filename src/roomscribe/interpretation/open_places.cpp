// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/open_places.hpp"

#include <algorithm>

namespace roomscribe {
namespace {

/// Two readings, and nothing that tells them apart.
constexpr double undecided = 0.5;

bool has(const Scene& scene, Label label) {
    return std::any_of(scene.components.begin(), scene.components.end(),
                       [label](const Component& component) { return component.label == label; });
}

}  // namespace

void doubt_open_places(Scene& scene, PointLabels& labels) {
    const bool has_wall = has(scene, Label::wall);
    const bool has_level = has(scene, Label::floor) || has(scene, Label::ceiling);
    if (has_wall && has_level) return;
    for (Component& component : scene.components) {
        component.confidence = std::min(component.confidence, undecided);
        if (component.verdict != Verdict::accepted) continue;
        component.verdict = Verdict::doubtful;
        component.evidence.alternative = has_level
                                             ? "no wall was seen: ground outdoors, or something "
                                               "else that is flat"
                                             : "neither floor nor ceiling was seen: a thing in the "
                                               "open, or of another size";
    }
    for (float& confidence : labels.confidences)
        confidence = std::min(confidence, static_cast<float>(undecided));
    if (!has_wall && !has_level) scene.rooms.clear();
}

}  // namespace roomscribe
