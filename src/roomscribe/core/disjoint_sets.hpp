// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace roomscribe {

/// Sets of the numbers below `count`, each alone at first.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    /// The number that stands for the set of `element`.
    std::uint32_t find(std::uint32_t element) {
        while (parent_[element] != element) {
            parent_[element] = parent_[parent_[element]];
            element = parent_[element];
        }
        return element;
    }

    /// Puts the set of `other` into that of `kept`, whose number stands for both.
    void join(std::uint32_t kept, std::uint32_t other) { parent_[find(other)] = find(kept); }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace roomscribe
