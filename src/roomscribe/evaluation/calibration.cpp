// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/calibration.hpp"

#include <algorithm>
#include <cmath>

namespace roomscribe {
namespace {

void add(CalibrationBin& bin, double confidence, bool is_correct) {
    ++bin.detections;
    bin.correct += is_correct ? 1U : 0U;
    bin.confidence_sum += confidence;
}

void add(CalibrationBin& bin, const CalibrationBin& other) {
    bin.detections += other.detections;
    bin.correct += other.correct;
    bin.confidence_sum += other.confidence_sum;
}

}  // namespace

std::optional<double> CalibrationBin::mean_confidence() const {
    if (detections == 0) return std::nullopt;
    return confidence_sum / static_cast<double>(detections);
}

std::optional<double> CalibrationBin::correct_share() const {
    if (detections == 0) return std::nullopt;
    return static_cast<double>(correct) / static_cast<double>(detections);
}

std::optional<double> Calibration::expected_error() const {
    double sum = 0.0;
    std::uint64_t detections = 0;
    for (const CalibrationBin& bin : bins) {
        sum += std::abs(bin.confidence_sum - static_cast<double>(bin.correct));
        detections += bin.detections;
    }
    if (detections == 0) return std::nullopt;
    return sum / static_cast<double>(detections);
}

Calibration& Calibration::operator+=(const Calibration& other) {
    for (std::size_t i = 0; i < num_bins; ++i)
        add(bins[i], other.bins[i]);
    add(accepted, other.accepted);
    add(doubtful, other.doubtful);
    return *this;
}

Calibration calibrate(std::span<const DetectionMatch> matches) {
    Calibration calibration;
    for (const DetectionMatch& match : matches) {
        const bool is_correct = match.outcome == DetectionOutcome::correct;
        if (!is_correct && match.outcome != DetectionOutcome::false_positive) continue;
        const double confidence = std::clamp(match.confidence, 0.0, 1.0);
        const auto bin = static_cast<std::size_t>(confidence * Calibration::num_bins);
        add(calibration.bins[std::min(bin, Calibration::num_bins - 1)], confidence, is_correct);
        add(match.verdict == Verdict::accepted ? calibration.accepted : calibration.doubtful,
            confidence, is_correct);
    }
    return calibration;
}

}  // namespace roomscribe
