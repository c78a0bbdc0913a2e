// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"

namespace roomscribe {

/// Numbers, ascending, of the returns that lie on no surface: dust, rain, sunlight, a broken file.
/// A return lies on one if others lie beside it no farther off than neighbouring rays part at its
/// range. A few strays do no harm and cannot be told from thin things: unless they are a hundredth
/// of the returns, there are none. `sensor` is where the rays begin, in the frame of the positions.
std::vector<std::uint32_t> find_stray_returns(std::span<const Eigen::Vector3f> positions,
                                              const Eigen::Vector3d& sensor,
                                              const Context& context = {});

}  // namespace roomscribe
