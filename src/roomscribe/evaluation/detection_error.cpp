// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/detection_error.hpp"

#include <algorithm>
#include <functional>
#include <tuple>

#include "roomscribe/evaluation/component_fit.hpp"
#include "roomscribe/evaluation/instance_overlap.hpp"
#include "roomscribe/evaluation/voxel_weights.hpp"

namespace roomscribe {
namespace {

struct Pair {
    std::size_t truth = 0;
    std::size_t predicted = 0;
    double score = 0.0;
};

/// Score of a true and a predicted component, by their numbers; empty if they may not match.
using Score = std::function<std::optional<double>(std::size_t truth, std::size_t predicted)>;

std::vector<std::size_t> components_of(const Scene& scene, Label label) {
    const std::vector<std::size_t> whole = whole_of_component(scene);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < scene.components.size(); ++i) {
        const Component& component = scene.components[i];
        const bool takes_part = component.label == label && whole[i] == i;
        if (takes_part && component.verdict != Verdict::rejected) found.push_back(i);
    }
    return found;
}

bool is_counted(const Component& true_component) {
    return true_component.visible.value_or(1.0) >= protocol::min_visible - protocol::rounding;
}

std::optional<double> above_min_iou(std::optional<double> iou) {
    if (!iou || *iou < protocol::min_iou - protocol::rounding) return std::nullopt;
    return iou;
}

std::optional<double> center_score(const Component& truth, const Component& predicted) {
    const std::optional<Eigen::Vector3d> a = component_center(truth);
    const std::optional<Eigen::Vector3d> b = component_center(predicted);
    if (!a || !b) return std::nullopt;
    const double distance = (*a - *b).norm();
    if (!(distance <= protocol::max_handle_distance + protocol::rounding)) return std::nullopt;
    return 1.0 - distance / protocol::max_handle_distance;
}

/// All pairs that may match, the best first.
std::vector<Pair> ranked_pairs(const std::vector<std::size_t>& truths,
                               const std::vector<std::size_t>& detections, const Score& score) {
    std::vector<Pair> pairs;
    for (const std::size_t truth : truths) {
        for (const std::size_t detection : detections) {
            if (const auto value = score(truth, detection))
                pairs.push_back({truth, detection, *value});
        }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.score > b.score; });
    return pairs;
}

/// Matches the components of one label.
class LabelMatcher {
  public:
    LabelMatcher(Label label, const Scene& truth, const Scene& predicted)
        : label_(label),
          truth_(truth),
          predicted_(predicted),
          truths_(components_of(truth, label)),
          detections_(components_of(predicted, label)),
          truth_is_matched_(truth.components.size()),
          detection_is_matched_(predicted.components.size()) {}

    void match(const Score& score, const std::function<bool(std::size_t)>& is_left_out,
               DetectionError& error) {
        const std::vector<Pair> pairs = ranked_pairs(truths_, detections_, score);
        for (const bool counted : {true, false}) {
            for (const Pair& pair : pairs) {
                if (is_counted(truth_.components[pair.truth]) == counted) take(pair, error);
            }
        }
        for (const std::size_t i : truths_) {
            if (truth_is_matched_[i]) continue;
            DetectionMatch& match = add(error, outcome_of(i, DetectionOutcome::missed));
            match.true_id = truth_.components[i].id;
        }
        for (const std::size_t i : detections_) {
            if (detection_is_matched_[i]) continue;
            describe_detection(i, add(error, is_left_out(i) ? DetectionOutcome::ignored
                                                            : DetectionOutcome::false_positive));
        }
    }

  private:
    DetectionOutcome outcome_of(std::size_t truth, DetectionOutcome outcome) const {
        return is_counted(truth_.components[truth]) ? outcome : DetectionOutcome::ignored;
    }

    void take(const Pair& pair, DetectionError& error) {
        if (truth_is_matched_[pair.truth] || detection_is_matched_[pair.predicted]) return;
        truth_is_matched_[pair.truth] = true;
        detection_is_matched_[pair.predicted] = true;
        DetectionMatch& match = add(error, outcome_of(pair.truth, DetectionOutcome::correct));
        match.true_id = truth_.components[pair.truth].id;
        match.score = pair.score;
        describe_detection(pair.predicted, match);
    }

    DetectionMatch& add(DetectionError& error, DetectionOutcome outcome) const {
        DetectionMatch& match = error.matches.emplace_back();
        match.label = label_;
        match.outcome = outcome;
        return match;
    }

    void describe_detection(std::size_t i, DetectionMatch& match) const {
        const Component& detection = predicted_.components[i];
        match.predicted_id = detection.id;
        match.confidence = detection.confidence;
        match.verdict = detection.verdict;
    }

    Label label_;
    const Scene& truth_;
    const Scene& predicted_;
    std::vector<std::size_t> truths_;
    std::vector<std::size_t> detections_;
    std::vector<bool> truth_is_matched_;
    std::vector<bool> detection_is_matched_;
};

DetectionCounts count(const std::vector<DetectionMatch>& matches, Label label) {
    DetectionCounts counts;
    for (const DetectionMatch& match : matches) {
        if (match.label != label) continue;
        const bool is_correct = match.outcome == DetectionOutcome::correct;
        counts.correct += is_correct ? 1U : 0U;
        counts.ground_truth += is_correct || match.outcome == DetectionOutcome::missed ? 1U : 0U;
        counts.false_positives += match.outcome == DetectionOutcome::false_positive ? 1U : 0U;
    }
    counts.scenes = counts.ground_truth > 0 ? 1U : 0U;
    return counts;
}

std::optional<double> ratio(double numerator, double denominator) {
    if (denominator == 0.0) return std::nullopt;
    return numerator / denominator;
}

}  // namespace

std::string_view detection_outcome_name(DetectionOutcome outcome) {
    switch (outcome) {
        case DetectionOutcome::correct:
            return "correct";
        case DetectionOutcome::missed:
            return "missed";
        case DetectionOutcome::false_positive:
            return "false_positive";
        case DetectionOutcome::ignored:
            return "ignored";
    }
    return "";
}

std::optional<double> DetectionCounts::accuracy() const {
    return ratio(static_cast<double>(correct), static_cast<double>(ground_truth));
}

std::optional<double> DetectionCounts::precision() const {
    return ratio(static_cast<double>(correct), static_cast<double>(correct + false_positives));
}

std::optional<double> DetectionCounts::f1() const {
    return ratio(2.0 * static_cast<double>(correct),
                 static_cast<double>(ground_truth + correct + false_positives));
}

DetectionCounts& DetectionCounts::operator+=(const DetectionCounts& other) {
    ground_truth += other.ground_truth;
    correct += other.correct;
    false_positives += other.false_positives;
    scenes += other.scenes;
    return *this;
}

DetectionError evaluate_detections(const GroundTruth& truth, const Prediction& prediction,
                                   LabelSet labels, const Context& context) {
    const InstanceOverlap overlap = measure_instance_overlap(
        truth, prediction, voxel_weights(truth.map.cloud.positions, protocol::voxel_size, context));
    const Scene true_scene =
        transformed_scene(truth.scene, predicted_from_true_map(truth, prediction));
    const Scene& predicted_scene = *prediction.scene;
    const auto components_at = [&](std::size_t t, std::size_t p) {
        return std::tie(true_scene.components[t], predicted_scene.components[p]);
    };

    const Score by_points = [&](std::size_t t, std::size_t p) {
        return above_min_iou(overlap.iou(t, p));
    };
    const Score by_rectangle = [&](std::size_t t, std::size_t p) {
        const auto [of_truth, detected] = components_at(t, p);
        return above_min_iou(rectangle_iou(of_truth.polygon, detected.polygon));
    };
    const Score by_center = [&](std::size_t t, std::size_t p) {
        const auto [of_truth, detected] = components_at(t, p);
        return center_score(of_truth, detected);
    };
    // Nobody can hold it against a result that it knows of what the scans hardly saw.
    const auto is_hidden_truth = [&](std::size_t p) {
        const Component& detected = predicted_scene.components[p];
        return std::any_of(true_scene.components.begin(), true_scene.components.end(),
                           [&](const Component& of_truth) {
                               return of_truth.label == detected.label && !is_counted(of_truth) &&
                                      lie_in_one_place(of_truth, detected);
                           });
    };
    const auto is_left_out = [&](std::size_t p) {
        const Label label = predicted_scene.components[p].label;
        if (!protocol::contains(protocol::instance_labels, label)) return false;
        if (!overlap.predicted_has_points[p]) return is_hidden_truth(p);
        return overlap.predicted_left_out[p] > 0.0 &&
               overlap.predicted_left_out[p] >= overlap.predicted_size[p];
    };

    DetectionError error;
    for (std::size_t id = 1; id < num_labels; ++id) {
        const auto label = static_cast<Label>(id);
        if (!protocol::contains(labels, label)) continue;
        const Score& score = protocol::contains(protocol::instance_labels, label)    ? by_points
                             : protocol::contains(protocol::rectangle_labels, label) ? by_rectangle
                                                                                     : by_center;
        LabelMatcher(label, true_scene, predicted_scene).match(score, is_left_out, error);
        error.per_label[id] = count(error.matches, label);
    }
    return error;
}

}  // namespace roomscribe
