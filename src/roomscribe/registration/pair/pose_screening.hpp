// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// How closely poses are looked at.
struct Screening {
    std::size_t num_witnesses = 300;  ///< of a scan, half of them details
    bool both_ways = true;            ///< whether the target's witnesses are heard, too
};

/// Confirmed less contradicted as a share of some witnesses, details counting more, by nearby
/// points instead of nearest ones: a quick score for each of many poses.
std::vector<double> screen_poses(const PreparedScan& source, const PreparedScan& target,
                                 std::span<const Transform> poses, const RegistrationScale& scale,
                                 const Screening& screening, const Context& context = {});

}  // namespace roomscribe
