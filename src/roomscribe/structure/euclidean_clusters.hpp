// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// The paper's Euclidean clusters (Algorithm 5): points that hang together by steps no longer than
/// `tolerance` m. `points` number some of the positions, ascending, all of them finite; each
/// cluster is ascending, the clusters are ordered by their first points.
std::vector<std::vector<std::uint32_t>> euclidean_clusters(
    std::span<const Eigen::Vector3f> positions, std::span<const std::uint32_t> points,
    double tolerance);

}  // namespace roomscribe
