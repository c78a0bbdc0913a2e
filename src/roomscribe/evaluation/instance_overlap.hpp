// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "roomscribe/evaluation/prediction.hpp"

namespace roomscribe {

/// How much true and predicted components share, in weighted points.
///
/// A point belongs to the component whose instance number it carries, if that component (its piece,
/// for a face of furniture) has the point's label. Left out, on both sides, are
/// - points whose predicted label is right without being the true one (GroundTruth::acceptable): a
///   column labelled wall neither helps nor hurts any wall;
/// - for a predicted component, points that truth gives its label but no component that is listed
///   (GroundTruth of other programs): truth does not say what they belong to.
struct InstanceOverlap {
    std::vector<double> true_size;           ///< per true component
    std::vector<double> predicted_size;      ///< per predicted component
    std::vector<double> predicted_left_out;  ///< likewise, not in predicted_size
    std::vector<bool> predicted_has_points;  ///< some point carries its number, whatever its label
    /// Key: true component * number of predicted components + predicted component.
    std::unordered_map<std::uint64_t, double> shared;

    /// Shared over together, in [0, 1]. 0 if either is empty.
    double iou(std::size_t true_component, std::size_t predicted_component) const;
};

/// Preconditions: labels and scene are given, and there is one weight per point of truth and
/// prediction.
InstanceOverlap measure_instance_overlap(const GroundTruth& truth, const Prediction& prediction,
                                         const std::vector<float>& weights);

}  // namespace roomscribe
