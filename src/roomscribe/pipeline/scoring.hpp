// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/evaluate.hpp"
#include "roomscribe/model/ground_truth.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe {

/// Holds a result in memory against truth (docs/evaluation.md). What the reconstruction does not
/// have, poses or labels, is not scored. Throws InvalidArgument if it has not the points of the
/// truth, in their order.
Evaluation score_reconstruction(const GroundTruth& truth, const Reconstruction& reconstruction,
                                const Context& context = {});

}  // namespace roomscribe
