// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/registration/pair/pair_settings.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// Joins sets of scans, each held together by accepted links, where ambiguous links alone lead from
/// one to the other. Every pose of such a link puts the two sets together as a whole, and then all
/// their scans that come near each other speak for or against it, not only the link's two. The
/// likeliest is accepted if it is likely enough, and so on with the larger sets.
void join_sets(std::vector<RegistrationLink>& links, std::span<const PreparedScan> scans,
               const PairRegistrationSettings& settings, const Context& context);

}  // namespace roomscribe
