// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

// Returns that no surface sent back: saturated_returns.hpp and, of what these leave,
// stray_returns.hpp.

/// A copy of the scan whose false returns are NaN, grid and order kept, without colours,
/// intensities and channels; nothing if it has none.
std::optional<Scan> without_false_returns(const Scan& scan, const Context& context = {});

/// A point whose coordinates were taken away for a while.
struct HiddenPoint {
    std::uint32_t number = 0;
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
};

/// Makes the false returns of a map NaN, scanner by scanner, where their places are known: a copy
/// of a large map would not fit beside it. Returns what to put back.
std::vector<HiddenPoint> hide_false_returns(ScanMap& map, const Context& context = {});

void put_back(std::span<const HiddenPoint> hidden, ScanMap& map);

}  // namespace roomscribe
