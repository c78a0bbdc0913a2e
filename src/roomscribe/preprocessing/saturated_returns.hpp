// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// Numbers, ascending, of the returns that lie at the very end of the scanner's range: some
/// scanners write their greatest range where no light came back. No surface looks like that: many
/// points at one range, hardly any just before it, in directions too far apart to be of one plane.
/// `sensor` is where the rays begin, in the frame of the positions.
std::vector<std::uint32_t> find_saturated_returns(std::span<const Eigen::Vector3f> positions,
                                                  const Eigen::Vector3d& sensor);

}  // namespace roomscribe
