// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/doubtful_places.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace roomscribe {
namespace {

/// Two readings, and nothing that tells them apart.
constexpr double undecided = 0.5;

bool has(const Scene& scene, Label label) {
    return std::any_of(scene.components.begin(), scene.components.end(),
                       [label](const Component& component) { return component.label == label; });
}

bool is_shell(Label label) {
    return label == Label::floor || label == Label::ceiling || label == Label::wall;
}

void put_all_in_doubt(std::string_view alternative, Scene& scene, PointLabels& labels) {
    for (Component& component : scene.components) {
        component.confidence = std::min(component.confidence, undecided);
        if (component.verdict != Verdict::accepted) continue;
        component.verdict = Verdict::doubtful;
        component.evidence.alternative = alternative;
    }
    for (float& confidence : labels.confidences)
        confidence = std::min(confidence, static_cast<float>(undecided));
}

}  // namespace

void doubt_open_places(Scene& scene, PointLabels& labels) {
    const bool has_wall = has(scene, Label::wall);
    const bool has_level = has(scene, Label::floor) || has(scene, Label::ceiling);
    if (has_wall && has_level) return;
    put_all_in_doubt(has_level
                         ? "no wall was seen: ground outdoors, or something else that is flat"
                         : "neither floor nor ceiling was seen: a thing in the open, or of another "
                           "size",
                     scene, labels);
    if (!has_wall && !has_level) scene.rooms.clear();
}

void doubt_blurred_places(Scene& scene, PointLabels& labels) {
    constexpr double bookcase_depth = 0.25;
    // Three standard deviations on either side of both planes: nothing would lie between them.
    constexpr double max_scatter = bookcase_depth / 6.0;
    double sum = 0.0;
    double num_points = 0.0;
    for (const Component& component : scene.components) {
        if (!component.evidence.rms || !is_shell(component.label)) continue;
        const auto weight = static_cast<double>(component.evidence.points);
        sum += weight * *component.evidence.rms;
        num_points += weight;
    }
    if (sum <= max_scatter * num_points) return;
    put_all_in_doubt(
        fmt::format("anything nearby: points scatter by {:.0f} cm", 100.0 * sum / num_points),
        scene, labels);
}

}  // namespace roomscribe
