// SPDX-License-Identifier: MIT
#include "roomscribe/structure/planar_patch.hpp"

#include <algorithm>
#include <cmath>

namespace roomscribe {

double occupied_area(std::span<const Eigen::Vector3f> positions,
                     std::span<const std::uint32_t> points, const Plane& plane, double cell_size) {
    if (points.empty()) return 0.0;
    const PlaneAxes axes = plane_axes(plane.normal);
    const Eigen::Vector3d origin = positions[points.front()].cast<double>();
    std::vector<std::uint64_t> cells;
    cells.reserve(points.size());
    for (const std::uint32_t point : points) {
        const Eigen::Vector3d offset = positions[point].cast<double>() - origin;
        const auto column = static_cast<std::int32_t>(std::floor(offset.dot(axes.u) / cell_size));
        const auto row = static_cast<std::int32_t>(std::floor(offset.dot(axes.v) / cell_size));
        cells.push_back((static_cast<std::uint64_t>(static_cast<std::uint32_t>(row)) << 32U) |
                        static_cast<std::uint32_t>(column));
    }
    std::sort(cells.begin(), cells.end());
    const auto occupied = std::unique(cells.begin(), cells.end()) - cells.begin();
    return static_cast<double>(occupied) * cell_size * cell_size;
}

}  // namespace roomscribe
