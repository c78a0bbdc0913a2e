// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// Answers at once which point lies near a place: a hash of cubic cells, each of which knows the
/// point nearest to its centre among those in it and its 26 neighbours. For points thinned to about
/// one a cell that is a near point, though not always the nearest.
class SurfaceGrid {
  public:
    /// Points that are not finite are left out. Precondition: cell_size > 0.
    SurfaceGrid(std::span<const Eigen::Vector3f> positions, double cell_size);

    /// Number of a point near the place; empty if none lies in the place's cell or those around it.
    std::optional<std::uint32_t> near(const Eigen::Vector3f& place) const;

  private:
    using Cell = Eigen::Vector3i;
    struct Slot {
        Cell cell = Cell::Zero();
        std::uint32_t point = nobody;
    };
    static constexpr std::uint32_t nobody = 0xffffffffU;

    Cell cell_of(const Eigen::Vector3f& place) const;
    /// The cell's slot, or the free one where it would be.
    std::size_t slot_of(const Cell& cell) const;
    void insert(const Cell& cell, std::uint32_t point, std::span<const Eigen::Vector3f> positions);
    void grow();

    float cell_size_;
    std::size_t num_used_ = 0;
    std::vector<Slot> slots_;
};

}  // namespace roomscribe
