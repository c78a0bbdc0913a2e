// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/scoring.hpp"

namespace roomscribe {

Evaluation score_reconstruction(const GroundTruth& truth, const Reconstruction& reconstruction,
                                const Context& context) {
    Prediction prediction;
    if (reconstruction.registration) {
        prediction.map_from_scan = reconstruction.registration->map_from_scan;
        prediction.links = reconstruction.registration->links;
    }
    if (!reconstruction.labels.labels.empty()) {
        prediction.scene = reconstruction.scene;
        prediction.labels = reconstruction.labels;
    }
    return evaluate_result(truth, prediction, protocol::every_label, context);
}

}  // namespace roomscribe
