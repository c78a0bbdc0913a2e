// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace roomscribe {

/// A cell that fewer rays passed through may owe them to stray points.
inline constexpr std::uint32_t min_cell_rays = 2;

/// What a cell of a FloorPlan is known to be, while the plan is drawn.
struct PlanCell {
    std::uint32_t num_rays = 0;
    Eigen::Vector2f rays_way = Eigen::Vector2f::Zero();  ///< sum of the directions of all rays
    float upright_top = -std::numeric_limits<float>::infinity();  ///< of upright surface seen in it
    bool has_floor = false;
    bool is_occupied = false;  ///< something was seen between floor and ceiling
    bool is_blind = false;     ///< rays passed, but no scanner could look down on the floor there
    bool is_solid = false;     ///< of a barrier: there is surface at the height of people too
};

}  // namespace roomscribe
