// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/length_unit.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

enum class LengthUnitStop : std::uint8_t {
    metres,  ///< median_distance <= 20, or the scan reads as a building in metres, or
             ///< median_distance <= 100 and it does so in no unit
    told,    ///< it reads as a building in one other unit alone
    untold   ///< median_distance > 100, and it reads as a building in none or several units
};

/// In which unit the coordinates of a scan are.
struct LengthUnitEstimate {
    LengthUnit unit = LengthUnit::metre;  ///< metre unless told
    LengthUnitStop stop = LengthUnitStop::metres;
    /// In the scan's unit: how far half of the points are from their middle.
    double median_distance = 0.0;
    /// m, in the unit told: from the floor to the ceiling, or to the end of what was seen.
    std::optional<double> room_height;
    std::string reason;  ///< of a unit that was told, in words
};

/// Metres, millimetres, centimetres or inches? To be asked before everything else, since every
/// stage takes its scan to be in metres. Costs next to nothing where half of the points are within
/// 20 of their middle, as in metres they are in all but the largest places. Else some of the points
/// are read in each unit in turn: planes, which way is up, floor and ceiling. The scan reads as a
/// building if most of its surface is planar and lies along three axes, the ceiling is 2.1 to 4 m
/// above the floor (building practice) and little was seen above it; where no ceiling was seen in
/// any unit, if what was seen ends 1.6 to 4 m above the floor. Either range spans less than the
/// factor 2.54 between neighbouring units. Feet are not told here, since a hall in metres looks
/// like a room in feet: see may_be_feet.
LengthUnitEstimate estimate_length_unit(const Scan& scan, const Context& context = {});

/// Whether rooms that were found, taken for metres, fit a building in feet and hardly one in
/// metres: all of them are 6.9 to 13.1 high (2.1 to 4 m in feet), and no scanner stood where none
/// stands if it is feet. `sensor_heights` are those above the floor, as far as known. False without
/// rooms.
bool may_be_feet(std::span<const Room> rooms, std::span<const double> sensor_heights);

}  // namespace roomscribe
