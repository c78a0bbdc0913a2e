// SPDX-License-Identifier: MIT
#include "roomscribe/structure/neighbor_graph.hpp"

#include <algorithm>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk = 2048;
constexpr std::uint32_t none = 0xFFFFFFFFU;

}  // namespace

NeighborGraph::NeighborGraph(std::span<const Eigen::Vector3f> positions, const SearchTree& tree,
                             int num_neighbors, const Context& context)
    : first_(positions.size() + 1, 0) {
    const std::size_t count = positions.size();
    const auto k = static_cast<std::size_t>(num_neighbors);
    std::vector<std::uint32_t> nearest(count * k, none);
    parallel_for(context, count, chunk, [&](std::size_t begin, std::size_t end) {
        std::vector<Neighbor> found;
        for (std::size_t i = begin; i < end; ++i) {
            tree.nearest(positions[i], k + 1, found);
            std::size_t kept = 0;
            for (const Neighbor& neighbor : found) {
                if (neighbor.index != i && kept < k) nearest[i * k + kept++] = neighbor.index;
            }
        }
    });

    std::vector<std::size_t> degree(count, 0);
    for (std::size_t e = 0; e < nearest.size(); ++e) {
        if (nearest[e] == none) continue;
        ++degree[e / k];
        ++degree[nearest[e]];
    }
    std::vector<std::size_t> start(count + 1, 0);
    for (std::size_t i = 0; i < count; ++i)
        start[i + 1] = start[i] + degree[i];
    std::vector<std::uint32_t> both(start[count]);
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (std::size_t e = 0; e < nearest.size(); ++e) {
        if (nearest[e] == none) continue;
        both[next[e / k]++] = nearest[e];
        both[next[nearest[e]]++] = static_cast<std::uint32_t>(e / k);
    }

    // Points that are among each other's nearest were tied twice.
    std::vector<std::size_t> distinct(count, 0);
    parallel_for(context, count, chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto from = both.begin() + static_cast<std::ptrdiff_t>(start[i]);
            const auto to = both.begin() + static_cast<std::ptrdiff_t>(start[i + 1]);
            std::sort(from, to);
            distinct[i] = static_cast<std::size_t>(std::unique(from, to) - from);
        }
    });
    for (std::size_t i = 0; i < count; ++i)
        first_[i + 1] = first_[i] + distinct[i];
    neighbors_.resize(first_[count]);
    for (std::size_t i = 0; i < count; ++i) {
        std::copy_n(both.begin() + static_cast<std::ptrdiff_t>(start[i]), distinct[i],
                    neighbors_.begin() + static_cast<std::ptrdiff_t>(first_[i]));
    }
}

}  // namespace roomscribe
