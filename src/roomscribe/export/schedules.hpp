// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "roomscribe/export/building.hpp"

namespace roomscribe {

/// A table of one kind of thing, as a file.
struct Schedule {
    std::string file_name;  ///< "doors.csv"
    std::string csv;        ///< RFC 4180 with a heading; lengths in m with 4 decimals
};

/// rooms, walls, doors, windows, furniture and handles, in this order; places and directions are
/// in the room frame. A table of nothing has its heading.
std::vector<Schedule> building_to_schedules(const Building& building);

}  // namespace roomscribe
