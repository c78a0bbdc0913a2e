// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// Where a person would put the scanner of the scenario to cover these rooms, in the order of a
/// walk: on free floor, away from walls and furniture, a step or a few metres from the station
/// before. A scanner that sees all around stands where it sees new things; one that looks one way
/// stands back from what it looks at and turns by less than its field of view from scan to scan.
/// `per_room` is the number of scans in each room; a room wider than 6 m gets more of those that
/// see all around. Throws InvalidArgument if a room has no free floor.
std::vector<Station> choose_stations(const Scenario& scenario, std::span<const std::size_t> rooms,
                                     int per_room, Random& random);

/// How many scans of a room this scanner needs to see it whole.
int usual_scans_per_room(ScannerKind scanner);

}  // namespace roomscribe
