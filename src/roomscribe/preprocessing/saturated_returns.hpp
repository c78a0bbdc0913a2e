// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Numbers, ascending, of the returns that lie at the very end of the scanner's range: some
/// scanners write their greatest range where no light came back. No surface looks like that: many
/// points at one range, hardly any just before it, in directions too far apart to be of one plane.
std::vector<std::uint32_t> find_saturated_returns(const Scan& scan);

/// A copy of the scan whose saturated returns are NaN, grid and order kept, without colours,
/// intensities and channels; nothing if it has none.
std::optional<Scan> without_saturated_returns(const Scan& scan);

/// A point whose coordinates were taken away for a while.
struct HiddenPoint {
    std::uint32_t number = 0;
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
};

/// Makes the saturated returns of a map NaN, scanner by scanner, where their places are known: a
/// copy of a large map would not fit beside it. Returns what to put back.
std::vector<HiddenPoint> hide_saturated_returns(ScanMap& map);

void put_back(std::span<const HiddenPoint> hidden, ScanMap& map);

}  // namespace roomscribe
