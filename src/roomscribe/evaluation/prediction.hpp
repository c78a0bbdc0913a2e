// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/ground_truth.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// A result that is held against truth. What a result has not is empty, and is not scored.
struct Prediction {
    std::optional<Scene> scene;
    /// Per point of the true map, in its order.
    std::optional<PointLabels> labels;
    /// Scan -> map of the result, empty for a scan without a place. No entries: the result was made
    /// in the frame of the true map.
    std::vector<std::optional<Transform>> map_from_scan;
    std::vector<RegistrationLink> links;
};

/// Number of the first scan that the result has placed: the one whose two poses tie the frame of
/// the result to that of the truth. Empty if there is none.
std::optional<std::size_t> anchor_scan(const Prediction& prediction);

/// The frame of the true map -> that of the result's map: through the anchor scan, or the identity
/// where there is none. Drift of the result away from its anchor thus counts against it.
Transform predicted_from_true_map(const GroundTruth& truth, const Prediction& prediction);

/// For each component, which one it counts with: the furniture piece at the end of its chain of
/// furniture parents for a face of furniture, itself for any other.
std::vector<std::size_t> whole_of_component(const Scene& scene);

}  // namespace roomscribe
