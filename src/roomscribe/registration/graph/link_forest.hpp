// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/registration_result.hpp"

namespace roomscribe {

/// Scans as links join them, each with its pose in the frame of its set's first scan.
struct LinkForest {
    std::vector<std::size_t> set_of;       ///< per scan: the lowest scan of its set
    std::vector<Transform> set_from_scan;  ///< per scan
    std::vector<bool> is_doubtful;         ///< per scan: joined to its set's first by way of an
                                           ///< ambiguous link
    std::vector<std::size_t> used_links;   ///< numbers of the links that join, ascending
};

/// Numbers of the links that may join scans, all accepted ones before any ambiguous one. Ambiguous
/// links are among them if they have at least the probability `min_ambiguous`; none is if it is not
/// given.
std::vector<std::size_t> likeliest_first(std::span<const RegistrationLink> links,
                                         std::optional<double> min_ambiguous = {});

/// Joins scans by the likeliest links (likeliest_first): a spanning tree per connected set.
LinkForest grow_forest(std::span<const RegistrationLink> links, std::size_t num_scans,
                       std::optional<double> min_ambiguous = {});

}  // namespace roomscribe
