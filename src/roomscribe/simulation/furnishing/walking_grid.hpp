// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/furnishing/footprint.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// The floor of a room in cells of 10 cm: where a walker of 0.28 m radius can stand.
class WalkingGrid {
  public:
    /// `entries` are places before the doors.
    WalkingGrid(const RoomPlan& room, std::span<const BuiltWallFace> walls,
                std::span<const Eigen::Vector2d> entries);

    /// Takes an obstacle's floor away.
    void take(const Footprint& obstacle);

    /// Takes that of the last obstacle; those of the others are taken. False, and nothing is taken,
    /// if then some door could not be reached from the first, less than `free_share` of
    /// the empty room's walkable floor could be, or no place for a scanner (0.9 m off the walls,
    /// 0.4 m off obstacles) were left where there was one.
    bool take_if_good(std::span<const Footprint> obstacles, double free_share);

  private:
    Eigen::Vector2d cell_center(std::size_t cell) const;
    std::size_t cell_at(const Eigen::Vector2d& point) const;
    /// Without entries, from the first free cell.
    std::vector<std::uint8_t> reachable() const;

    Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
    std::size_t columns_ = 0;
    std::vector<std::size_t> entries_;
    std::vector<std::uint8_t> blocked_;
    std::vector<std::uint8_t> is_roomy_;  ///< far enough from walls for a scanner
    std::size_t num_walkable_ = 0;        ///< of the empty room
    std::size_t num_roomy_ = 0;           ///< of the empty room
};

}  // namespace roomscribe
