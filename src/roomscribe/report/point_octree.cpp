// SPDX-License-Identifier: MIT
#include "roomscribe/report/point_octree.hpp"

#include <algorithm>
#include <bit>
#include <optional>

namespace roomscribe {
namespace {

constexpr unsigned grid_levels = 16;
/// Octree levels that lie between a node and its cells.
constexpr unsigned levels_in_node = std::countr_zero(PointOctree::cells);

/// A point is shown with the first node that has it in a cell of its own.
std::uint8_t depth_of(std::uint8_t level) {
    if (level <= levels_in_node) return 0;
    return std::min(static_cast<std::uint8_t>(level - levels_in_node), PointOctree::max_depth);
}

std::array<std::uint16_t, 3> place_at(const std::array<std::uint16_t, 3>& place,
                                      std::uint8_t depth) {
    std::array<std::uint16_t, 3> node{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        node[axis] = static_cast<std::uint16_t>(place[axis] >> (grid_levels - depth));
    return node;
}

}  // namespace

PointOctree build_point_octree(const GriddedPoints& points) {
    PointOctree octree;
    // Points come along the curve, so that a node's are over when another of its depth begins.
    std::array<std::optional<std::size_t>, PointOctree::max_depth + 1> current{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint8_t depth = depth_of(points.levels[i]);
        const auto place = place_at(points.places[i], depth);
        std::optional<std::size_t>& node = current[depth];
        if (!node || octree.nodes[*node].place != place) {
            node = octree.nodes.size();
            octree.nodes.push_back({depth, place, {}});
        }
        octree.nodes[*node].points.push_back(static_cast<std::uint32_t>(i));
    }
    return octree;
}

}  // namespace roomscribe
