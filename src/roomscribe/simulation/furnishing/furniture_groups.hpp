// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "roomscribe/simulation/furnishing/furnisher.hpp"

namespace roomscribe {

/// Of what has doors or drawers.
inline constexpr Demands with_doors{.front_space = 0.6};
/// Of what may stand before windows, too.
inline constexpr Demands anywhere{.avoids_windows = false};

/// Along a wall, or off it as far as a radiator wants.
std::optional<ItemPlan> place_near_wall(Furnisher& f, const ItemPlan& item, const Demands& demands);

/// A desk or two that face each other, with a chair, a screen and what people have on desks.
void add_desk(Furnisher& f);

/// A set of chairs around a table, most drawn up to it; a share of the seats.
void add_chairs(Furnisher& f, const ItemPlan& table, double share);

// home_programmes.cpp: what the rooms of a dwelling hold. `density` is in [0, 1].
void furnish_kitchen(Furnisher& f, double density);
void furnish_living(Furnisher& f, double density);
void furnish_bedroom(Furnisher& f, double density);
void furnish_bath(Furnisher& f, double density);

}  // namespace roomscribe
