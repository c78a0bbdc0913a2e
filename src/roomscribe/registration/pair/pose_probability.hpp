// SPDX-License-Identifier: MIT
#pragma once

namespace roomscribe {

/// How the best pose of two scans stands, in pieces of detail (PoseSupport::evidence).
struct PoseStanding {
    double evidence = 0.0;
    double lead = 0.0;  ///< over the best different pose with evidence; all of it if there is none
    /// Whether all poses were looked at that bring the scans' surfaces together. Of two scans that
    /// do not face three ways the right pose may have been missed, and then no lead tells.
    bool is_exhaustive = false;
};

/// That a pose with such evidence is right if it has no rivals, in [0, 1].
double probability_without_rivals(const PoseStanding& standing);

/// That the pose is right, in [0, 1]: logistic in evidence and lead, fitted to simulated pairs of
/// all scanners with and without overlap (docs/registration.md).
double probability_of(const PoseStanding& standing);

}  // namespace roomscribe
