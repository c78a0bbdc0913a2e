// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/scenario.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

/// A leaf of a door, in the frame of its site.
struct DoorLeaf {
    WallArea area;            ///< when closed
    double y_low = 0.0;       ///< of its far side when closed
    double hinge_side = 1.0;  ///< +1: hinged at x_high, -1: at x_low
    double angle = 0.0;       ///< rad from closed, towards `swing`
    double swing = 1.0;       ///< +1: into the room, -1: out of it
};

/// One leaf, or the left and the right one of a double door.
std::vector<DoorLeaf> door_leaves(const OpeningPlan& opening, const OpeningSite& site);

/// Takes the leaf from where it is when closed to where it stands: it turns about its hinge, which
/// sits on the side to which it opens.
Transform frame_of_leaf(const Transform& world_from_site, const DoorLeaf& leaf);

/// Adds what fills an opening: lining or reveal, threshold, frame, leaves, levers, panes, mullions,
/// sill, blind, the back of a niche. `wall` and `floor` are the components of the room to which the
/// bare masonry and the threshold belong. The hole in the wall face is the building's. Returns the
/// component that rooms are connected through: the door, or for a passage the `opening`; -1 for the
/// others.
std::int32_t add_opening(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site,
                         std::int32_t wall, std::int32_t floor);

}  // namespace roomscribe
