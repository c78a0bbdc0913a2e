// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "roomscribe/evaluation/prediction.hpp"

namespace roomscribe {

/// How points are labelled and how they should be. Counts of points.
struct PointAgreement {
    /// [right label][predicted label]: the right label is the predicted one if that is acceptable,
    /// else the true one.
    std::array<std::array<std::uint64_t, num_labels>, num_labels> confusion{};
    /// Points whose true label it is, whatever else is acceptable.
    std::array<std::uint64_t, num_labels> true_points{};

    /// Points rightly given the label over points given it or owed it; empty if there are none.
    std::optional<double> iou(Label label) const;
    /// Mean over the labels 1 to 9 that truth has points of; empty if there are none.
    std::optional<double> mean_iou() const;

    PointAgreement& operator+=(const PointAgreement& other);
};

/// Counts the points with finite coordinates. A point for which every label is acceptable says
/// nothing and is left out. Precondition: one label per point of truth and prediction.
PointAgreement compare_point_labels(const GroundTruth& truth, const PointLabels& predicted);

}  // namespace roomscribe
