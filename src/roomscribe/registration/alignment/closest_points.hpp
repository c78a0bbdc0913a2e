// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {

/// Nearest target points of slowly moving queries. What a search has found is remembered with the
/// distance within which it cannot be wrong: while a query has moved less than half of its lead
/// over the second nearest point, it is answered without a search, with the same answer.
class ClosestPoints {
  public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// `tree` was made of `positions`; both must outlive this.
    ClosestPoints(std::span<const Eigen::Vector3f> positions, const SearchTree& tree,
                  std::size_t num_queries)
        : positions_(positions), tree_(tree), memories_(num_queries) {}

    /// Number of the target point nearest to a query's present place; `none` if no target point is
    /// within `max_distance`. Different queries may be asked for at the same time.
    std::uint32_t find(std::size_t query, const Eigen::Vector3f& place, float max_distance);

  private:
    struct Memory {
        Eigen::Vector3f place = Eigen::Vector3f::Zero();  ///< where it was searched
        std::uint32_t nearest = none;
        float clear = 0.0F;  ///< no other target point was nearer to `place` than this
    };

    std::span<const Eigen::Vector3f> positions_;
    const SearchTree& tree_;
    std::vector<Memory> memories_;
};

}  // namespace roomscribe
