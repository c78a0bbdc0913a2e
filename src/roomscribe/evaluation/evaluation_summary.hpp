// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/evaluation/calibration.hpp"
#include "roomscribe/evaluation/evaluate.hpp"

namespace roomscribe {

/// Verdicts of links against what is true: [verdict][LinkTruth].
using LinkCounts = std::array<std::array<std::uint64_t, link_truth_names.size()>, 3>;

/// Many scenes together (or one): counts are summed over the scenes, and shares follow from the
/// sums, so that a scene weighs as much as it holds. Errors are kept one by one, ascending.
struct EvaluationSummary {
    std::size_t scenes = 0;
    std::array<DetectionCounts, num_labels> detections{};
    Calibration calibration;
    std::array<DecoyCounts, decoy_kind_names.size()> decoys{};
    OpeningGrounds opening_grounds{};
    DetectionCounts rooms;
    DetectionCounts neighbors;
    // Of the rooms that were matched and count: how far off, without sign.
    std::vector<double> area_errors;    ///< shares of what is true
    std::vector<double> height_errors;  ///< m
    std::vector<double> volume_errors;  ///< shares
    PointAgreement points;
    std::vector<double> up_errors;           ///< rad, one per scene with a result
    std::vector<double> horizontal_errors;   ///< rad
    std::vector<ScanError> scans;            ///< of all scenes, anchors left out
    std::vector<double> translation_errors;  ///< m, of the scans that have a place
    std::vector<double> rotation_errors;     ///< rad
    LinkCounts links{};
};

EvaluationSummary summarize(std::span<const Evaluation> evaluations);

/// The value below which a share of the values lies (nearest rank: the smallest value that at least
/// the share does not exceed). `sorted` ascends; empty for none. Precondition: 0 <= share <= 1.
std::optional<double> percentile(std::span<const double> sorted, double share);

}  // namespace roomscribe
