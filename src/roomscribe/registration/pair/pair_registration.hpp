// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/registration/pair/pair_settings.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// Two scans without any guess (the paper's Algorithm 1 and beyond): matches, candidate poses,
/// verification of each against both scans, refinement by ICP, verdict. The link's scan numbers are
/// left 0. Precondition: both scans were prepared for settings.features. A pair without overlap
/// comes back rejected, with the best pose that was found.
RegistrationLink register_pair(const PreparedScan& source, const PreparedScan& target,
                               std::uint64_t seed, const PairRegistrationSettings& settings = {},
                               const Context& context = {});

/// Two scans whose relative pose is known to the reach of ICP, three coarse voxels: refinement from
/// there and the verdict of register_pair, but for the search for rivals.
RegistrationLink register_pair_from(const PreparedScan& source, const PreparedScan& target,
                                    const Transform& target_from_source_guess,
                                    const PairRegistrationSettings& settings = {},
                                    const Context& context = {});

}  // namespace roomscribe
