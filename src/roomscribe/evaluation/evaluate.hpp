// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/axes_error.hpp"
#include "roomscribe/evaluation/decoy_error.hpp"
#include "roomscribe/evaluation/detection_error.hpp"
#include "roomscribe/evaluation/point_agreement.hpp"
#include "roomscribe/evaluation/prediction.hpp"
#include "roomscribe/evaluation/registration_error.hpp"
#include "roomscribe/evaluation/room_error.hpp"

namespace roomscribe {

/// How one result compares with the truth of its scene. Empty is what the result does not have, or
/// the truth does not tell.
struct Evaluation {
    std::optional<DetectionError> detections;
    std::optional<DecoyError> decoys;
    std::optional<RoomError> rooms;
    std::optional<PointAgreement> points;
    std::optional<AxesError> axes;
    std::optional<RegistrationError> registration;
};

/// The whole protocol (docs/evaluation.md). `labels` are those that truth tells all components of
/// (evaluate_detections). Detections need scene and labels, axes the scene, rooms the scene and
/// rooms in truth, decoys the scene and truth that tells of doors and windows, registration poses.
/// Throws InvalidArgument if the prediction has not one label per point, or neither no pose slots
/// nor one per scan, or a link of a scan that is not there.
Evaluation evaluate_result(const GroundTruth& truth, const Prediction& prediction,
                           LabelSet labels = protocol::every_label, const Context& context = {});

}  // namespace roomscribe
