// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/simulation/furnishing/item_builder.hpp"
#include "roomscribe/simulation/handles.hpp"

namespace roomscribe {

/// Where on a door a handle sits: base units have it high, wall units low, tall doors in reach.
enum class HandleHeight : std::uint8_t { high, in_reach, low };

/// What all fronts of a piece have in common.
struct FrontStyle {
    double thickness = 0.019;
    double gap = 0.004;       ///< between neighbouring fronts
    double setback = 0.002;   ///< of the carcass behind a closed front
    double back_space = 0.0;  ///< of the carcass before the piece's back
    Material material = Material::wood;
    Material carcass = Material::wood;
    HandleStyle handle;
    HandleHeight handle_height = HandleHeight::high;
    bool is_framed = false;               ///< doors with a raised frame around a panel
    bool has_handles_above = false;       ///< drawers: near the upper edge, not in the middle
    bool has_level_door_handles = false;  ///< along the door's edge, not upright
    double ajar_share = 0.1;              ///< of doors; drawers half as often
};

/// Overlay fronts 16 to 22 mm thick with gaps of 3 to 5 mm and one make of handle.
FrontStyle choose_front_style(Random& random, Material material);

enum class BayContent : std::uint8_t {
    door,
    double_door,
    drawers,
    drawer_and_door,         ///< a drawer above a door
    drawer_and_double_door,  ///< a drawer above a pair of doors
    oven,                    ///< black glass door that drops, a panel above it
    flap,                    ///< one front hinged below: dishwasher
    shelves,                 ///< open
};

/// The body behind a stretch of a piece's front: solid, or hollow with boards and things on them.
void add_carcass(ItemBuilder& builder, const FaceArea& area, const FrontStyle& style,
                 bool is_hollow);

/// Builds the part of a piece behind the outline [area.low, area.high] of its front plane: carcass
/// from the piece's back, fronts with their gaps, handles. The carcass is hollow, with boards and
/// things on them, where a door stands open or is absent.
void add_bay(ItemBuilder& builder, const FaceArea& area, BayContent content,
             const FrontStyle& style, int num_drawers = 3);

}  // namespace roomscribe
