// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "roomscribe/model/scene.hpp"

namespace roomscribe {

// Drawings of the model with dimensions, as HTML. Empty where there is nothing to draw. What is
// rejected is left out.

/// The floor plan of each storey, as `export --to svg` writes it.
std::string floor_plan_drawing(const Scene& scene);

/// Every wall as it is seen from its room, with its openings: leaf or glass in its frame, widths
/// along its foot, heights at its side, all walls to one scale, which on paper is 1:50 or, where a
/// wall is longer than a page is wide, 1:100 or 1:200.
std::string wall_elevations(const Scene& scene);

}  // namespace roomscribe
