// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "roomscribe/export/building.hpp"

namespace roomscribe {

/// What the header of an IFC file says of its making.
struct IfcOrigin {
    std::string file_name = "model.ifc";
    std::string time_stamp = "1970-01-01T00:00:00";  ///< ISO 8601
    std::string version;                             ///< of the program
};

/// A building as IFC4 (ISO 16739-1, STEP file), in metres in the room frame. Walls have an axis and
/// a body, are joined where they meet and voided by openings, which doors and windows fill; rooms
/// are spaces with quantities; floors are slabs, ceilings coverings, pieces of furniture boxes.
/// OverallWidth and OverallHeight are of the leaf and of the glazed part, as scene.json has them;
/// the opening is as large as the frame. All carry Pset_Roomscribe: id, confidence, verdict. Global
/// ids follow from the scene and the component's id.
std::string building_to_ifc(const Building& building, const IfcOrigin& origin = {});

}  // namespace roomscribe
