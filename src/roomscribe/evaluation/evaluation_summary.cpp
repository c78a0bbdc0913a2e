// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/evaluation_summary.hpp"

#include <algorithm>
#include <cmath>

namespace roomscribe {
namespace {

void add_registration(EvaluationSummary& summary, const RegistrationError& registration) {
    summary.scans.insert(summary.scans.end(), registration.scans.begin(), registration.scans.end());
    for (const ScanError& scan : registration.scans) {
        if (!scan.error) continue;
        summary.translation_errors.push_back(scan.error->translation);
        summary.rotation_errors.push_back(scan.error->rotation);
    }
    for (const LinkOutcome& link : registration.links) {
        ++summary
              .links[static_cast<std::size_t>(link.verdict)][static_cast<std::size_t>(link.truth)];
    }
}

void add_rooms(EvaluationSummary& summary, const RoomError& rooms) {
    summary.rooms += rooms.rooms;
    summary.neighbors += rooms.neighbors;
    for (const RoomMatch& match : rooms.matches) {
        if (match.outcome != DetectionOutcome::correct) continue;
        summary.area_errors.push_back(std::abs(match.area_error));
        summary.height_errors.push_back(std::abs(match.height_error));
        summary.volume_errors.push_back(std::abs(match.volume_error));
    }
}

void add_decoys(EvaluationSummary& summary, const DecoyError& decoys) {
    for (std::size_t kind = 0; kind < decoys.per_kind.size(); ++kind)
        summary.decoys[kind] += decoys.per_kind[kind];
    for (const DetectedOpening& opening : decoys.openings)
        ++summary.opening_grounds[static_cast<std::size_t>(opening.ground)];
}

}  // namespace

EvaluationSummary summarize(std::span<const Evaluation> evaluations) {
    EvaluationSummary summary;
    summary.scenes = evaluations.size();
    for (const Evaluation& evaluation : evaluations) {
        if (evaluation.detections) {
            for (std::size_t id = 0; id < num_labels; ++id)
                summary.detections[id] += evaluation.detections->per_label[id];
            summary.calibration += calibrate(evaluation.detections->matches);
        }
        if (evaluation.decoys) add_decoys(summary, *evaluation.decoys);
        if (evaluation.rooms) add_rooms(summary, *evaluation.rooms);
        if (evaluation.points) summary.points += *evaluation.points;
        if (evaluation.axes) {
            summary.up_errors.push_back(evaluation.axes->up);
            summary.horizontal_errors.push_back(evaluation.axes->horizontal);
        }
        if (evaluation.registration) add_registration(summary, *evaluation.registration);
    }
    for (std::vector<double>* errors :
         {&summary.area_errors, &summary.height_errors, &summary.volume_errors, &summary.up_errors,
          &summary.horizontal_errors, &summary.translation_errors, &summary.rotation_errors}) {
        std::sort(errors->begin(), errors->end());
    }
    return summary;
}

std::optional<double> percentile(std::span<const double> sorted, double share) {
    if (sorted.empty()) return std::nullopt;
    const double rank = std::ceil(share * static_cast<double>(sorted.size()) - 1e-9);
    const auto index = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
    return sorted[std::min(index, sorted.size() - 1)];
}

}  // namespace roomscribe
