// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/prediction.hpp"
#include "roomscribe/evaluation/protocol.hpp"

namespace roomscribe {

enum class DetectionOutcome : std::uint8_t {
    correct,         ///< a true component and its detection
    missed,          ///< a true component without a detection
    false_positive,  ///< a detection without a true component
    ignored          ///< neither hit nor miss
};
std::string_view detection_outcome_name(DetectionOutcome outcome);

/// A true component, a detection, or the two together.
struct DetectionMatch {
    Label label = Label::unknown;
    DetectionOutcome outcome = DetectionOutcome::missed;
    std::string true_id;       ///< empty for a false positive
    std::string predicted_id;  ///< empty for a miss
    /// IoU of instances or rectangles; of handles 1 - distance / greatest distance. 0 if unmatched.
    double score = 0.0;
    double confidence = 0.0;              ///< of the detection
    Verdict verdict = Verdict::accepted;  ///< of the detection
};

struct DetectionCounts {
    std::uint64_t ground_truth = 0;  ///< true components that count
    std::uint64_t correct = 0;
    std::uint64_t false_positives = 0;
    std::uint64_t scenes = 0;  ///< in which ground_truth > 0

    // Empty where the denominator is 0.
    std::optional<double> accuracy() const;  ///< correct / ground truth (paper, Table 4)
    std::optional<double> precision() const;
    std::optional<double> f1() const;

    DetectionCounts& operator+=(const DetectionCounts& other);
};

struct DetectionError {
    std::array<DetectionCounts, num_labels> per_label{};
    std::vector<DetectionMatch>
        matches;  ///< by label, then matches by falling score, then the rest
};

/// Compares components label by label as the protocol says (docs/evaluation.md).
///
/// Who takes part: true components of the label; detections of the label that are not rejected. A
/// furniture face whose parent is a piece of the same scene counts with the piece (its points are
/// the piece's) and is neither a true component nor a detection of its own; a face without such a
/// parent is a piece. `visible` is that of the piece; a true component without `visible` counts as
/// seen.
///
/// Who may match: floor, ceiling, wall, furniture by measure_instance_overlap; doors, windows and
/// their frames by planes and rectangles, the detection's rectangle projected onto the true plane
/// and the distance taken from the centre of its corners; handles by the centres of their boxes
/// (without box: of their polygon, else the grasp's position). What has no such geometry matches
/// nothing.
///
/// Who is matched: the best pairs first (of equal ones the earlier true component, then the earlier
/// detection), each component once. True components with `visible` below the limit come after all
/// others: a detection that is left for one of them is ignored with it. Ignored too is, of the
/// labels that are compared by points, an unmatched detection at least half of whose points were
/// left out of the overlap (a column taken for a wall), or that has no points (what lies where
/// nobody saw).
///
/// `labels` are those that truth tells all components of; others are not looked at.
/// Preconditions as for measure_instance_overlap.
DetectionError evaluate_detections(const GroundTruth& truth, const Prediction& prediction,
                                   LabelSet labels = protocol::every_label,
                                   const Context& context = {});

}  // namespace roomscribe
