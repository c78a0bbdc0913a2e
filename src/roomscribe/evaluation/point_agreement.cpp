// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/point_agreement.hpp"

#include "roomscribe/evaluation/protocol.hpp"

namespace roomscribe {

std::optional<double> PointAgreement::iou(Label label) const {
    const auto id = static_cast<std::size_t>(label);
    std::uint64_t either = 0;
    for (std::size_t other = 0; other < num_labels; ++other)
        either += confusion[id][other] + confusion[other][id];
    either -= confusion[id][id];
    if (either == 0) return std::nullopt;
    return static_cast<double>(confusion[id][id]) / static_cast<double>(either);
}

std::optional<double> PointAgreement::mean_iou() const {
    double sum = 0.0;
    int num_present = 0;
    for (std::size_t id = 1; id < num_labels; ++id) {
        const std::optional<double> of_label = iou(static_cast<Label>(id));
        if (true_points[id] == 0 || !of_label) continue;
        sum += *of_label;
        ++num_present;
    }
    if (num_present == 0) return std::nullopt;
    return sum / num_present;
}

PointAgreement& PointAgreement::operator+=(const PointAgreement& other) {
    for (std::size_t right = 0; right < num_labels; ++right) {
        for (std::size_t predicted = 0; predicted < num_labels; ++predicted)
            confusion[right][predicted] += other.confusion[right][predicted];
        true_points[right] += other.true_points[right];
    }
    return *this;
}

PointAgreement compare_point_labels(const GroundTruth& truth, const PointLabels& predicted) {
    PointAgreement agreement;
    for (std::size_t i = 0; i < truth.labels.size(); ++i) {
        const LabelSet acceptable = truth.acceptable[i];
        if (acceptable == protocol::every_label || !is_finite(truth.map.cloud.positions[i])) {
            continue;
        }
        const Label label = predicted.labels[i];
        const Label right = protocol::contains(acceptable, label) ? label : truth.labels[i];
        ++agreement.confusion[static_cast<std::size_t>(right)][static_cast<std::size_t>(label)];
        ++agreement.true_points[static_cast<std::size_t>(truth.labels[i])];
    }
    return agreement;
}

}  // namespace roomscribe
