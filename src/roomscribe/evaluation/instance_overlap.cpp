// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/instance_overlap.hpp"

#include <optional>

#include "roomscribe/evaluation/protocol.hpp"

namespace roomscribe {
namespace {

/// Finds the component that a point belongs to, with furniture faces as their pieces.
class ComponentFinder {
  public:
    explicit ComponentFinder(const Scene& scene) : scene_(scene) {
        const std::vector<std::size_t> whole = whole_of_component(scene);
        for (std::size_t i = 0; i < whole.size(); ++i) {
            if (scene.components[i].verdict == Verdict::rejected) continue;
            component_of_instance_.emplace(scene.components[i].instance, whole[i]);
        }
    }

    std::optional<std::size_t> find(std::int32_t instance) {
        if (instance < 0) return std::nullopt;
        // Neighbouring points mostly belong to the same component.
        if (instance != last_instance_) {
            const auto found = component_of_instance_.find(instance);
            last_instance_ = instance;
            last_component_.reset();
            if (found != component_of_instance_.end()) last_component_ = found->second;
        }
        return last_component_;
    }

    /// The component, if it has the label.
    std::optional<std::size_t> with_label(std::optional<std::size_t> component, Label label) const {
        if (!component || scene_.components[*component].label != label) return std::nullopt;
        return component;
    }

  private:
    const Scene& scene_;
    std::unordered_map<std::int32_t, std::size_t> component_of_instance_;
    std::int32_t last_instance_ = -1;
    std::optional<std::size_t> last_component_;
};

}  // namespace

double InstanceOverlap::iou(std::size_t true_component, std::size_t predicted_component) const {
    const auto found = shared.find(true_component * predicted_size.size() + predicted_component);
    if (found == shared.end()) return 0.0;
    const double together =
        true_size[true_component] + predicted_size[predicted_component] - found->second;
    return together > 0.0 ? found->second / together : 0.0;
}

InstanceOverlap measure_instance_overlap(const GroundTruth& truth, const Prediction& prediction,
                                         const std::vector<float>& weights) {
    const PointLabels& predicted = *prediction.labels;
    const std::size_t num_predicted = prediction.scene->components.size();
    InstanceOverlap overlap;
    overlap.true_size.resize(truth.scene.components.size());
    overlap.predicted_size.resize(num_predicted);
    overlap.predicted_left_out.resize(num_predicted);
    overlap.predicted_has_points.resize(num_predicted);
    ComponentFinder true_components(truth.scene);
    ComponentFinder predicted_components(*prediction.scene);

    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0.0F) continue;
        const double weight = weights[i];
        const Label true_label = truth.labels[i];
        const Label label = predicted.labels[i];
        const auto named = predicted_components.find(predicted.instances[i]);
        if (named) overlap.predicted_has_points[*named] = true;
        const auto of_prediction = predicted_components.with_label(named, label);
        const auto of_truth =
            true_components.with_label(true_components.find(truth.instances[i]), true_label);

        const bool is_also_right =
            label != true_label && protocol::contains(truth.acceptable[i], label);
        const bool is_unlisted = label == true_label && !of_truth;
        if (is_also_right || is_unlisted) {
            if (of_prediction) overlap.predicted_left_out[*of_prediction] += weight;
            continue;
        }
        if (of_truth) overlap.true_size[*of_truth] += weight;
        if (of_prediction) overlap.predicted_size[*of_prediction] += weight;
        if (of_truth && of_prediction && label == true_label) {
            overlap.shared[*of_truth * num_predicted + *of_prediction] += weight;
        }
    }
    return overlap;
}

}  // namespace roomscribe
