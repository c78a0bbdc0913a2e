// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/voxel_weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {
namespace {

constexpr std::uint64_t no_voxel = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t chunk_size = 65536;

/// Three coordinates of 21 bits; what lies farther out shares the outermost voxels.
std::uint64_t voxel_key(const Eigen::Vector3f& point, double voxel_size) {
    constexpr double limit = 1 << 20;
    std::uint64_t key = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double cell = std::floor(static_cast<double>(point[axis]) / voxel_size);
        const double clamped = std::clamp(cell, -limit, limit - 1.0);
        key = (key << 21U) | static_cast<std::uint64_t>(clamped + limit);
    }
    return key;
}

std::vector<std::uint64_t> voxel_keys(std::span<const Eigen::Vector3f> points, double voxel_size,
                                      const Context& context) {
    std::vector<std::uint64_t> keys(points.size());
    parallel_for(context, points.size(), chunk_size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            keys[i] = is_finite(points[i]) ? voxel_key(points[i], voxel_size) : no_voxel;
    });
    return keys;
}

/// Numbers the voxels in the order in which they are met: a hash table with open addressing.
class VoxelNumbering {
  public:
    std::uint32_t number_of(std::uint64_t key) {
        if (2 * keys_.size() >= slots_.size()) grow();
        const std::size_t slot = find(key);
        if (slots_[slot] == empty) {
            slots_[slot] = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slots_[slot];
    }
    const std::vector<std::uint64_t>& keys() const { return keys_; }

  private:
    static constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();

    std::size_t find(std::uint64_t key) const {
        std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> shift_;
        while (slots_[slot] != empty && keys_[slots_[slot]] != key)
            slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }
    void grow() {
        slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), empty);
        shift_ = 64U - static_cast<unsigned>(std::log2(slots_.size()));
        for (std::uint32_t i = 0; i < keys_.size(); ++i)
            slots_[find(keys_[i])] = i;
    }

    std::vector<std::uint64_t> keys_;
    std::vector<std::uint32_t> slots_;
    unsigned shift_ = 0;
};

}  // namespace

std::vector<float> voxel_weights(std::span<const Eigen::Vector3f> points, double voxel_size,
                                 const Context& context) {
    const std::vector<std::uint64_t> keys = voxel_keys(points, voxel_size, context);
    VoxelNumbering numbering;
    std::vector<std::uint32_t> voxel_of_point(points.size());
    std::vector<std::uint32_t> num_points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (keys[i] == no_voxel) continue;
        const std::uint32_t voxel = numbering.number_of(keys[i]);
        voxel_of_point[i] = voxel;
        if (voxel == num_points.size()) num_points.push_back(0);
        ++num_points[voxel];
    }
    std::vector<float> weights(points.size(), 0.0F);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (keys[i] == no_voxel) continue;
        weights[i] = 1.0F / static_cast<float>(num_points[voxel_of_point[i]]);
    }
    return weights;
}

std::vector<std::uint64_t> filled_voxels(std::span<const Eigen::Vector3f> points, double voxel_size,
                                         const Context& context) {
    VoxelNumbering numbering;
    for (const std::uint64_t key : voxel_keys(points, voxel_size, context)) {
        if (key != no_voxel) numbering.number_of(key);
    }
    std::vector<std::uint64_t> filled = numbering.keys();
    std::sort(filled.begin(), filled.end());
    return filled;
}

}  // namespace roomscribe
