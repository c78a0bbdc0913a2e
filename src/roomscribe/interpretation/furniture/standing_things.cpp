// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/standing_things.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace roomscribe {
namespace {

/// m. Parts of one thing are no further apart than two cells.
constexpr double cell_size = 0.1;
/// m above the floor. Lower, it is the floor's own unevenness, a rug or a threshold.
constexpr double min_height = 0.05;
/// m above the floor. What stands on feet or legs shows something under this height.
constexpr double foot_height = 0.35;
/// m below the ceiling. Lamps and cornices.
constexpr double ceiling_margin = 0.1;

using Cell = std::array<int, 3>;

struct CellVoxels {
    std::vector<std::uint32_t> voxels;
    bool is_low = false;
    bool is_reached = false;
};

}  // namespace

std::vector<bool> find_standing_things(const SurfaceSample& sample, const RoomSurfaces& surfaces,
                                       std::span<const Label> labels, const Context& context) {
    std::vector<std::uint32_t> num_points(sample.cloud.size(), 0);
    std::vector<std::uint32_t> num_unknown(sample.cloud.size(), 0);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel) continue;
        ++num_points[voxel];
        num_unknown[voxel] += labels[i] == Label::unknown ? 1 : 0;
    }
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    std::vector<bool> stands(sample.cloud.size(), false);
    for (const StoreyLayout& storey : surfaces.storeys) {
        context.throw_if_cancelled();
        std::map<Cell, CellVoxels> cells;
        for (std::uint32_t voxel = 0; voxel < sample.cloud.size(); ++voxel) {
            if (2 * num_unknown[voxel] < num_points[voxel]) continue;
            const Eigen::Vector3d point = axes * sample.cloud.positions[voxel].cast<double>();
            const std::int32_t room = storey.plan.room_at(point.head<2>());
            if (room == no_room) continue;
            const PlanRoom& seen = storey.plan.rooms[static_cast<std::size_t>(room)];
            const double height = point.z() - seen.floor_height;
            if (height < min_height) continue;
            if (seen.ceiling_height && point.z() > *seen.ceiling_height - ceiling_margin) continue;
            CellVoxels& cell = cells[{static_cast<int>(std::floor(point.x() / cell_size)),
                                      static_cast<int>(std::floor(point.y() / cell_size)),
                                      static_cast<int>(std::floor(height / cell_size))}];
            cell.voxels.push_back(voxel);
            cell.is_low = cell.is_low || height <= foot_height;
        }
        std::vector<Cell> stack;
        for (auto& [place, cell] : cells) {
            if (!cell.is_low || cell.is_reached) continue;
            cell.is_reached = true;
            stack.push_back(place);
            while (!stack.empty()) {
                const Cell at = stack.back();
                stack.pop_back();
                for (int code = 0; code < 27; ++code) {
                    const auto next = cells.find(
                        {at[0] + code % 3 - 1, at[1] + code / 3 % 3 - 1, at[2] + code / 9 - 1});
                    if (next == cells.end() || next->second.is_reached) continue;
                    next->second.is_reached = true;
                    stack.push_back(next->first);
                }
            }
        }
        for (const auto& [place, cell] : cells) {
            if (!cell.is_reached) continue;
            for (const std::uint32_t voxel : cell.voxels)
                stands[voxel] = true;
        }
    }
    return stands;
}

}  // namespace roomscribe
