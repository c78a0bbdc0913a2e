// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/core/context.hpp"
#include "roomscribe/simulation/scanning/scanner.hpp"
#include "roomscribe/simulation/scanning/scanner_model.hpp"

namespace roomscribe {

/// Fills positions, intensities and truth of a scan by a scanner that sends beams. `scan` has its
/// pose, and its arrays their size, with no return anywhere.
void scan_by_beams(SimulatedScan& scan, const RayCaster& caster, const ScannerModel& model,
                   std::uint64_t seed, const Context& context);

}  // namespace roomscribe
