// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/simulation/scanning/light_path.hpp"
#include "roomscribe/simulation/scanning/scanner_model.hpp"

namespace roomscribe {

/// What a scanner makes of all that one beam meets.
struct BeamReturn {
    Echo echo;                ///< range and strength of the whole, part of the larger share
    LabelSet acceptable = 0;  ///< labels that are right for the point
};

/// A beam so far from any edge that one thin ray, with or without echo, stands for it.
BeamReturn thin_beam(const SimulatedWorld& world, const Echo& echo);

/// Spreads the beam about its middle ray, whose echo is `center`, over its cross section at
/// `range`. What lies within the scanner's pulse resolution melts into one range, weighted by the
/// light that returns, the earlier the more; of several such groups the strongest is taken. If the
/// group joins components, each of their labels, and unknown, is right. At panes and glossy
/// surfaces the whole beam meets the `luck` of its middle ray.
BeamReturn spread_beam(const RayCaster& caster, const ScannerModel& model,
                       const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       const Echo& center, double range, const Random& luck);

}  // namespace roomscribe
