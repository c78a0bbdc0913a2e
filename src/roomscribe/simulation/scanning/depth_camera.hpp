// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/core/context.hpp"
#include "roomscribe/simulation/scanning/scanner.hpp"
#include "roomscribe/simulation/scanning/scanner_model.hpp"

namespace roomscribe {

/// Fills positions and truth of a frame of a structured-light camera: depth from the disparity
/// between its projector and its camera, so noise and steps grow with the depth squared, and what
/// the projector does not see is missing. `scan` has its pose, and its arrays their size, with no
/// return anywhere.
void scan_by_pattern(SimulatedScan& scan, const RayCaster& caster, const ScannerModel& model,
                     std::uint64_t seed, const Context& context);

}  // namespace roomscribe
