// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "roomscribe/export/building.hpp"

namespace roomscribe {

/// A building as binary glTF 2.0 (.glb), in metres. glTF has y up: (x, y, z) of the room frame is
/// (x, z, -y). Nodes: storey > room > component, named by their ids, each component with one mesh
/// in the colour of its label, and its kind, confidence and verdict as extras. Walls have holes
/// where their openings are. A component without extent is left out.
std::string building_to_glb(const Building& building);

}  // namespace roomscribe
