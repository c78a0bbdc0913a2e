// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "roomscribe/evaluation/detection_error.hpp"
#include "roomscribe/evaluation/prediction.hpp"

namespace roomscribe {

/// A true room, a found one, or the two together.
struct RoomMatch {
    DetectionOutcome outcome = DetectionOutcome::missed;
    std::string true_id;       ///< empty for a false positive
    std::string predicted_id;  ///< empty for a miss
    double iou = 0.0;          ///< of the floors, 0 if unmatched
    // Of a match: found less true.
    double area_error = 0.0;    ///< share of the true floor area
    double height_error = 0.0;  ///< m, from floor to ceiling
    double volume_error = 0.0;  ///< share of the true volume
};

struct RoomError {
    DetectionCounts rooms;
    /// Pairs of rooms that a door or passage joins.
    DetectionCounts neighbors;
    std::vector<RoomMatch> matches;  ///< by falling IoU, then the rest
};

/// Share of a true room that the scans saw: the mean `visible` of its floor, ceiling and walls by
/// their area (those whose parent it is; without `visible`: 1). 1 for a room that has none.
double room_visibility(const Scene& truth, const Room& room);

/// Compares rooms as the protocol says (docs/evaluation.md): by the IoU of their floors seen along
/// the true up, if the floors are less than half of the true room's height apart. Best pairs first,
/// each room once; first the true rooms of which enough was seen, then the others. An unmatched
/// found room is ignored if half of it lies in true rooms of which too little was seen.
///
/// A pair of true neighbours counts if both rooms do and enough was seen of a door between them. A
/// found pair is false if the rooms it means are no neighbours, or one of them is no room; it is
/// ignored if it means a pair or a room that does not count.
///
/// Precondition: the prediction has a scene.
RoomError evaluate_rooms(const GroundTruth& truth, const Prediction& prediction);

}  // namespace roomscribe
