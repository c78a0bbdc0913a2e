// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {

/// Which points are near each other, both ways: i is a neighbour of j whenever j is one of i.
/// Nearest neighbours rather than a radius, so that a thinly sampled part of a surface hangs
/// together and is tied to a dense one.
class NeighborGraph {
  public:
    /// Ties every point to its `num_neighbors` nearest others. Precondition: `tree` was made of
    /// `positions`.
    NeighborGraph(std::span<const Eigen::Vector3f> positions, const SearchTree& tree,
                  int num_neighbors, const Context& context = {});

    /// Ascending, without the point itself.
    std::span<const std::uint32_t> neighbors(std::uint32_t point) const {
        return {neighbors_.data() + first_[point], first_[point + 1] - first_[point]};
    }
    std::size_t size() const { return first_.size() - 1; }

  private:
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> neighbors_;
};

}  // namespace roomscribe
