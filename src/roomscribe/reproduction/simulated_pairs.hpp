// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Two overlapping scans.
struct ScanPair {
    Scan target;
    Scan source;
    std::optional<Transform> target_from_source;  ///< where the truth is known
};

// Stand-ins for the paper's scans, which are not public: what its scanner, a tilting SICK LMS200,
// records of made-up places, with every second ray along rows and columns. The robot goes a step of
// half a metre to a metre and turns by up to 20 degrees from one scan to the next.

/// A furnished office.
ScanPair simulate_cluttered_pair(std::uint64_t seed, const Context& context = {});
/// A corridor: walls, doors and little else.
ScanPair simulate_plane_pair(std::uint64_t seed, const Context& context = {});
/// A street: flat ground, a small building, plain houses, trees, bins and posts.
ScanPair simulate_outdoor_pair(std::uint64_t seed, const Context& context = {});

/// Furnished offices, kitchens and living rooms, a pair of each in turn.
std::vector<ScanPair> simulate_pairs(std::size_t count, std::uint64_t seed,
                                     const Context& context = {});

/// Two scans of a furnished office from one place, the scanner turned by 45 degrees in between.
ScanPair simulate_turned_pair(std::uint64_t seed, const Context& context = {});

}  // namespace roomscribe
