// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Numbers, ascending, of the returns that lie at the very end of the scanner's range: some
/// scanners write their greatest range where no light came back. No surface looks like that: many
/// points at one range, hardly any just before it, in directions too far apart to be of one plane.
std::vector<std::uint32_t> find_saturated_returns(const Scan& scan);

/// A copy of the scan whose saturated returns are NaN, grid and order kept; nothing if it has none.
std::optional<Scan> without_saturated_returns(const Scan& scan);

/// The same for a map, scanner by scanner, where their places are known.
std::optional<ScanMap> without_saturated_returns(const ScanMap& map);

}  // namespace roomscribe
