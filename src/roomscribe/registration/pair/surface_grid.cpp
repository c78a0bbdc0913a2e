// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/surface_grid.hpp"

#include <cmath>
#include <utility>

namespace roomscribe {

SurfaceGrid::SurfaceGrid(std::span<const Eigen::Vector3f> positions, double cell_size)
    : cell_size_(static_cast<float>(cell_size)), slots_(1024) {
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (!positions[i].allFinite()) continue;
        const Cell center = cell_of(positions[i]);
        for (int x = -1; x <= 1; ++x) {
            for (int y = -1; y <= 1; ++y) {
                for (int z = -1; z <= 1; ++z)
                    insert(center + Cell(x, y, z), i, positions);
            }
        }
    }
}

std::optional<std::uint32_t> SurfaceGrid::near(const Eigen::Vector3f& place) const {
    const std::uint32_t point = slots_[slot_of(cell_of(place))].point;
    if (point == nobody) return std::nullopt;
    return point;
}

SurfaceGrid::Cell SurfaceGrid::cell_of(const Eigen::Vector3f& place) const {
    return (place / cell_size_).array().floor().cast<int>();
}

std::size_t SurfaceGrid::slot_of(const Cell& cell) const {
    const auto x = static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.x()));
    const auto y = static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.y()));
    const auto z = static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.z()));
    std::uint64_t hash =
        x * 0x9e3779b97f4a7c15ULL ^ y * 0xc2b2ae3d27d4eb4fULL ^ z * 0x165667b19e3779f9ULL;
    hash ^= hash >> 32U;
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>(hash) & mask;
    while (slots_[slot].point != nobody && slots_[slot].cell != cell)
        slot = (slot + 1) & mask;
    return slot;
}

void SurfaceGrid::insert(const Cell& cell, std::uint32_t point,
                         std::span<const Eigen::Vector3f> positions) {
    if (2 * num_used_ >= slots_.size()) grow();
    Slot& slot = slots_[slot_of(cell)];
    if (slot.point == nobody) {
        slot = {cell, point};
        ++num_used_;
        return;
    }
    const Eigen::Vector3f middle = (cell.cast<float>().array() + 0.5F) * cell_size_;
    if ((positions[point] - middle).squaredNorm() <
        (positions[slot.point] - middle).squaredNorm()) {
        slot.point = point;
    }
}

void SurfaceGrid::grow() {
    std::vector<Slot> old(2 * slots_.size());
    std::swap(old, slots_);
    for (const Slot& slot : old) {
        if (slot.point != nobody) slots_[slot_of(slot.cell)] = slot;
    }
}

}  // namespace roomscribe
