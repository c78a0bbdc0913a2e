// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/reproduction/algorithm_1.hpp"
#include "roomscribe/reproduction/paper_pair.hpp"

namespace roomscribe {

/// The paper's Fig. 1 as SVG, self-contained: (a) all correspondences, (b) those that
/// sample-consensus rejection keeps, as lines between the two scans, which stand side by side as
/// seen from above (along z), each in its own frame with x upwards. Ceilings are left out. Where
/// the true pose is known, the picture says how far the second scan is turned.
std::string draw_correspondences(const PaperPair& pair, const FilteredMatches& matches,
                                 const std::optional<Transform>& true_target_from_source = {});

}  // namespace roomscribe
