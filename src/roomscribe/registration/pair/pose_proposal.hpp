// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/pair/pair_settings.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// The most promising of all poses that bring surfaces together, target from source, best first:
/// thinned in two steps, of which the first drops what is plainly wrong. Empty where search_poses
/// finds none.
std::vector<Transform> propose_from_surfaces(const PreparedScan& source, const PreparedScan& target,
                                             const RegistrationScale& scale,
                                             const PairRegistrationSettings& settings,
                                             const Context& context);

/// Poses that many matches of points agree on: one by the paper's sample consensus, or several from
/// the compatibility graph. Precondition: both scans were prepared for settings.features.
std::vector<Transform> propose_from_matches(const PreparedScan& source, const PreparedScan& target,
                                            const RegistrationScale& scale, std::uint64_t seed,
                                            const PairRegistrationSettings& settings,
                                            const Context& context);

}  // namespace roomscribe
