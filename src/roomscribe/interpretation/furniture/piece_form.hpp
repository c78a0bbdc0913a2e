// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

namespace roomscribe {

/// A draft's size and form.
struct PieceForm {
    PlanRectangle rectangle;
    double bottom = 0.0;        ///< m above the floor
    double top = 0.0;           ///< m above the floor
    double front_top = 0.0;     ///< m above the floor, where its front ends
    double level = 0.0;         ///< share of the voxels that are level
    double upright = 0.0;       ///< share of the voxels that are upright
    double seat = 0.0;          ///< m above the floor, of its main slab; 0 for none
    double seat_area = 0.0;     ///< m2, of its main slab; 0 for none
    double highest_slab = 0.0;  ///< m above the floor; 0 for none
    double closed = 0.0;   ///< share of the sides below the main slab that upright surface closes
    double surface = 0.0;  ///< m2, of all voxels
    double face = 0.0;     ///< m2, of the largest flat surface
    double planar = 0.0;   ///< share of the voxels that are part of a flat surface
    bool is_at_wall = false;  ///< its back is nearer than a hand's breadth to a wall
    /// In the room frame, level, off the wall that it stands at; zero for none.
    Eigen::Vector2d off_wall = Eigen::Vector2d::Zero();
    double blur = 0.0;   ///< m, by which noise makes what is flat look thick
    double depth = 0.0;  ///< m, from that wall to its front; 0 for no wall
    bool reaches_ceiling = false;
    bool is_chair = false;      ///< PieceDraft::is_chair
    bool is_under_top = false;  ///< PieceDraft::is_under_top
    std::size_t num_voxels = 0;
    std::size_t num_slabs = 0;
};

/// Measures a draft by its voxels and slabs, and the room and wall that it stands at. A draft
/// without voxels has no size. Precondition: its voxels are of one room.
PieceForm measure_form(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                       const PieceDraft& draft, const RoomSurfaces& surfaces);

}  // namespace roomscribe
