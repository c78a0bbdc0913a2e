// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "roomscribe/model/scene.hpp"

namespace roomscribe {

// What `export --to csv` lists, as tables of the report: without what is rejected. Empty where
// there is nothing to list. Positions and directions are in the room frame.

/// Doors and windows: size of leaf or glass and of the frame, height above the room's floor.
std::string openings_table(const Scene& scene);

/// Handles: where a gripper takes hold, from where it comes, and how what they are on opens.
std::string handles_table(const Scene& scene);

}  // namespace roomscribe
