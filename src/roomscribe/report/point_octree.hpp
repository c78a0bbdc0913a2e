// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "roomscribe/report/viewer_points.hpp"

namespace roomscribe {

/// A cube of an octree over the points' cube, with the points that it adds to those of the nodes
/// around it.
struct OctreeNode {
    std::uint8_t depth = 0;
    std::array<std::uint16_t, 3> place{};  ///< of 2^depth cubes along each axis
    std::vector<std::uint32_t> points;     ///< numbers into GriddedPoints, ascending
};

/// A node and those around it have, of each of `cells`^3 cells of the node, one point, where there
/// is any; the deepest nodes have all that are left.
struct PointOctree {
    static constexpr unsigned cells = 128;
    static constexpr std::uint8_t max_depth = 6;
    std::vector<OctreeNode> nodes;  ///< the root first; every point is in one of them
};

/// Empty if there are no points.
PointOctree build_point_octree(const GriddedPoints& points);

}  // namespace roomscribe
