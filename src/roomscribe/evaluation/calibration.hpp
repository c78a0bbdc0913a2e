// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "roomscribe/evaluation/detection_error.hpp"

namespace roomscribe {

/// Detections that said about the same of themselves, and how many of them were right.
struct CalibrationBin {
    std::uint64_t detections = 0;
    std::uint64_t correct = 0;
    double confidence_sum = 0.0;

    std::optional<double> mean_confidence() const;
    std::optional<double> correct_share() const;
};

/// Whether detections know how sure they are. Ignored detections and misses are left out.
struct Calibration {
    static constexpr std::size_t num_bins = 10;

    /// By confidence, of equal width: bin i holds [i / 10, (i + 1) / 10), the last one also 1.
    std::array<CalibrationBin, num_bins> bins{};
    CalibrationBin accepted;  ///< detections by their verdict
    CalibrationBin doubtful;

    /// Expected calibration error (Guo et al. 2017): mean over the detections of how far the
    /// confidence of their bin is from the share that is correct. Empty without detections.
    std::optional<double> expected_error() const;

    Calibration& operator+=(const Calibration& other);
};

Calibration calibrate(std::span<const DetectionMatch> matches);

}  // namespace roomscribe
