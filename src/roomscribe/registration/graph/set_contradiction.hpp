// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// A link that joins two sets of scans puts all scans of the one among those of the other. Joins
/// scans by accepted links and by ambiguous ones that are likely enough to place by, the likeliest
/// first, and rejects each that the scans which it brings near each other contradict, all their
/// witnesses taken together. Returns whether an accepted link was rejected.
bool reject_what_sets_contradict(std::vector<RegistrationLink>& links,
                                 std::span<const PreparedScan> scans, double min_ambiguous,
                                 const Context& context = {});

}  // namespace roomscribe
