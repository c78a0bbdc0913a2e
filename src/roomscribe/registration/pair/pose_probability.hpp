// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

namespace roomscribe {

/// How much a search tells: whether all poses were looked at that bring the scans' surfaces
/// together, and how much of the place these saw. Where the right one may have been missed, no lead
/// tells; what a camera sees of a corner or a row of like doors fits many.
enum class PoseSearch : std::uint8_t {
    exhaustive,  ///< both scans face three ways, and not both are frames of cameras
    wide,        ///< else, of scans that see around themselves: little is hidden from both
    narrow       ///< else, and all frames of cameras
};

/// How the best pose of two scans stands, in pieces of detail (PoseSupport::evidence).
struct PoseStanding {
    double evidence = 0.0;
    std::optional<double> rival;  ///< evidence of the best different pose that has any
    PoseSearch search = PoseSearch::narrow;
};

/// That a pose with such evidence is right if it has no rivals, in [0, 1].
double probability_without_rivals(const PoseStanding& standing);

/// That the pose is right, in [0, 1]: logistic in evidence and lead, fitted to simulated pairs of
/// all scanners with and without overlap (docs/registration.md).
double probability_of(const PoseStanding& standing);

}  // namespace roomscribe
