// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/registration/graph/pose_graph.hpp"
#include "roomscribe/registration/graph/scan_graph.hpp"

namespace roomscribe {

/// What becomes of known poses.
enum class KnownPoseUse : std::uint8_t {
    prior,  ///< they take part like links, with their deviations
    fixed   ///< they are kept
};

/// An ambiguous link is right as often as its probability says: below this it does more harm than
/// good to place a scan by it.
inline constexpr double min_probability_to_place = 0.5;

/// Poses of the sets of scans that accepted links and ambiguous ones of at least the probability
/// `min_ambiguous` join, and how good they are; the largest set is the map. A spanning tree of the
/// likeliest links gives the start, the pose graph of all accepted links and of those ambiguous
/// ones that alone hold a scan the result. Known poses (one entry per scan,
/// or none) that are kept define the frame instead of the first scan, and join scans as links do;
/// those that are priors only pull. `noise` (m) is that of the scans: no link is trusted to better
/// than a tenth of it.
Registration place_scans(std::vector<RegistrationLink> links, std::size_t num_scans,
                         std::span<const std::optional<KnownPose>> known, KnownPoseUse use,
                         double noise, double min_ambiguous = min_probability_to_place,
                         const PoseGraphSettings& settings = {}, const Context& context = {});

}  // namespace roomscribe
