// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/evaluate.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

void require_size(const char* what, std::size_t size, std::size_t expected) {
    if (size == expected) return;
    throw InvalidArgument(what, fmt::format("{} entries", size), fmt::format("{}", expected));
}

void check(const GroundTruth& truth, const Prediction& prediction) {
    const std::size_t num_points = truth.map.cloud.size();
    const std::size_t num_scans = truth.map_from_scan.size();
    require_size("truth.labels", truth.labels.size(), num_points);
    require_size("truth.instances", truth.instances.size(), num_points);
    require_size("truth.acceptable", truth.acceptable.size(), num_points);
    if (prediction.labels) {
        require_size("prediction.labels", prediction.labels->labels.size(), num_points);
        require_size("prediction.instances", prediction.labels->instances.size(), num_points);
    }
    if (!prediction.map_from_scan.empty()) {
        require_size("prediction.map_from_scan", prediction.map_from_scan.size(), num_scans);
    }
    for (const RegistrationLink& link : prediction.links) {
        const std::size_t last = std::max(link.source, link.target);
        if (last < num_scans) continue;
        throw InvalidArgument("prediction.links", fmt::format("a link of scan {}", last),
                              fmt::format("one of the {} scans", num_scans));
    }
}

}  // namespace

Evaluation evaluate_result(const GroundTruth& truth, const Prediction& prediction, LabelSet labels,
                           const Context& context) {
    check(truth, prediction);
    Evaluation evaluation;
    if (prediction.labels && prediction.scene)
        evaluation.detections = evaluate_detections(truth, prediction, labels, context);
    context.throw_if_cancelled();
    if (prediction.labels) evaluation.points = compare_point_labels(truth, *prediction.labels);
    constexpr LabelSet openings = label_bit(Label::door) | label_bit(Label::window);
    if (prediction.scene && (labels & openings) == openings)
        evaluation.decoys = evaluate_decoys(truth, prediction);
    if (prediction.scene && !truth.scene.rooms.empty())
        evaluation.rooms = evaluate_rooms(truth, prediction);
    if (prediction.scene) {
        const Transform true_from_predicted = predicted_from_true_map(truth, prediction).inverse();
        evaluation.axes = compare_axes(truth.scene.room_from_map * true_from_predicted,
                                       prediction.scene->room_from_map);
    }
    if (!prediction.map_from_scan.empty())
        evaluation.registration = evaluate_registration(truth, prediction, context);
    return evaluation;
}

}  // namespace roomscribe
