// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/graph/link_forest.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// A scan of one set and one of another, as a pose of the sets puts them.
struct PairAcross {
    std::size_t source = 0;
    std::size_t target = 0;
    Transform target_from_source = Transform::Identity();
    double distance = 0.0;  ///< m, between the middles of the scans
};

/// The pairs that lie nearest to each other, so many at most, nearest first. Sets are named by
/// their lowest scans, whose frames are theirs.
std::vector<PairAcross> nearest_across(std::span<const PreparedScan> scans,
                                       const LinkForest& forest, std::size_t source_set,
                                       std::size_t target_set,
                                       const Transform& target_set_from_source_set,
                                       std::size_t max_pairs);

}  // namespace roomscribe
