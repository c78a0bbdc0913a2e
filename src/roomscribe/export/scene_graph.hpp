// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "roomscribe/export/building.hpp"

namespace roomscribe {

/// A building as a graph in JSON: `nodes` (storeys, rooms and components, with id, type, size,
/// centre in the room frame, confidence and verdict) and `edges` (from, to, relation): `contains`
/// runs storey > room > wall > opening > handle and room > furniture > face > handle; `leads_to`
/// joins rooms through a door; `back_of` joins the faces of one wall (also those beside each
/// other); `frames` a frame and what is in it.
std::string building_to_graph(const Building& building);

}  // namespace roomscribe
