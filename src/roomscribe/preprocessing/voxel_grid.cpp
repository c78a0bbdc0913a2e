// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/voxel_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace roomscribe {
namespace {

using Cell = std::array<std::int32_t, 3>;

/// A point so far out that its cell has no 32-bit number is no return of any scanner.
constexpr double max_cell = 1e9;

std::uint64_t hash(const Cell& cell) {
    std::uint64_t value = 0;
    for (const std::int32_t coordinate : cell) {
        value = (value ^ static_cast<std::uint32_t>(coordinate)) * 0x9E3779B97F4A7C15ULL;
        value ^= value >> 32U;
    }
    return value;
}

/// Numbers cells in the order in which they are first seen: a hash table with open addressing.
class CellNumbering {
  public:
    CellNumbering() : slots_(1024, no_voxel) {}

    std::uint32_t number_of(const Cell& cell) {
        if (2 * cells_.size() >= slots_.size()) grow();
        std::uint32_t& slot = slots_[find_slot(cell)];
        if (slot == no_voxel) {
            slot = static_cast<std::uint32_t>(cells_.size());
            cells_.push_back(cell);
        }
        return slot;
    }
    const std::vector<Cell>& cells() const { return cells_; }

  private:
    std::size_t find_slot(const Cell& cell) const {
        std::size_t slot = hash(cell) & (slots_.size() - 1);
        while (slots_[slot] != no_voxel && cells_[slots_[slot]] != cell) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        return slot;
    }
    void grow() {
        slots_.assign(slots_.size() * 4, no_voxel);
        for (std::uint32_t i = 0; i < cells_.size(); ++i)
            slots_[find_slot(cells_[i])] = i;
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Cell> cells_;
};

/// Fills voxel_of_point with voxels numbered in sorted order of their cells; returns how many.
std::size_t assign_voxels(const std::vector<Eigen::Vector3f>& positions, double voxel_size,
                          std::vector<std::uint32_t>& voxel_of_point) {
    CellNumbering numbering;
    voxel_of_point.assign(positions.size(), no_voxel);
    const double scale = 1.0 / voxel_size;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Eigen::Vector3d scaled = (positions[i].cast<double>() * scale).array().floor();
        if (!(scaled.cwiseAbs().maxCoeff() < max_cell) || !scaled.allFinite()) continue;
        voxel_of_point[i] = numbering.number_of({static_cast<std::int32_t>(scaled.x()),
                                                 static_cast<std::int32_t>(scaled.y()),
                                                 static_cast<std::int32_t>(scaled.z())});
    }

    const std::vector<Cell>& cells = numbering.cells();
    std::vector<std::uint32_t> order(cells.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&cells](std::uint32_t a, std::uint32_t b) { return cells[a] < cells[b]; });
    std::vector<std::uint32_t> rank(cells.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        rank[order[i]] = i;
    for (std::uint32_t& voxel : voxel_of_point) {
        if (voxel != no_voxel) voxel = rank[voxel];
    }
    return cells.size();
}

std::vector<Eigen::Vector3d> sum_by_voxel(const std::vector<Eigen::Vector3f>& values,
                                          const std::vector<std::uint32_t>& voxel_of_point,
                                          std::size_t num_voxels) {
    std::vector<Eigen::Vector3d> sums(num_voxels, Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (voxel_of_point[i] != no_voxel && values[i].allFinite()) {
            sums[voxel_of_point[i]] += values[i].cast<double>();
        }
    }
    return sums;
}

}  // namespace

VoxelGrid downsample_voxel_grid(const PointCloud& cloud, const VoxelGridSettings& settings,
                                const Context& context) {
    check_settings(settings);
    context.throw_if_cancelled();
    VoxelGrid grid;
    const std::size_t num_voxels =
        assign_voxels(cloud.positions, settings.voxel_size, grid.voxel_of_point);
    grid.num_points.assign(num_voxels, 0);
    for (const std::uint32_t voxel : grid.voxel_of_point) {
        if (voxel != no_voxel) ++grid.num_points[voxel];
    }

    const auto centroids = sum_by_voxel(cloud.positions, grid.voxel_of_point, num_voxels);
    grid.cloud.positions.reserve(num_voxels);
    for (std::size_t i = 0; i < num_voxels; ++i) {
        grid.cloud.positions.emplace_back((centroids[i] / grid.num_points[i]).cast<float>());
    }
    if (!cloud.normals.empty()) {
        grid.cloud.normals.reserve(num_voxels);
        for (const auto& sum : sum_by_voxel(cloud.normals, grid.voxel_of_point, num_voxels)) {
            // 0 / 0 where normals cancel out or are all NaN: none is better than a wrong one.
            grid.cloud.normals.emplace_back((sum / sum.norm()).cast<float>());
        }
    }
    grid.cloud.sensor_pose = cloud.sensor_pose;
    grid.cloud.global_shift = cloud.global_shift;
    return grid;
}

}  // namespace roomscribe
