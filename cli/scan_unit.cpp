// SPDX-License-Identifier: MIT
#include "cli/scan_unit.hpp"

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/interpretation/upright/length_unit_estimate.hpp"

namespace roomscribe::cli {
namespace {

ScanUnit tell_unit(std::span<const Scan> scans, std::span<const std::string> paths,
                   const Context& context) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
        const LengthUnitEstimate estimate = estimate_length_unit(scans[i], context);
        if (estimate.stop == LengthUnitStop::told) return {estimate.unit, estimate.reason};
        if (estimate.stop == LengthUnitStop::metres) continue;
        const bool is_last = i + 1 == scans.size();
        if (!is_last) continue;
        throw IoError(paths[i], "", {},
                      fmt::format("half of the points are more than {:.0f} from their middle, too "
                                  "far for a place indoors in metres",
                                  estimate.median_distance),
                      "say which unit the coordinates have: --unit mm, cm, in or ft; --unit m if "
                      "they are metres after all");
    }
    return {};
}

}  // namespace

ScanUnit convert_to_metres(std::vector<Scan>& scans, std::span<const std::string> paths,
                           std::optional<LengthUnit> given, const Context& context) {
    ScanUnit unit = given ? ScanUnit{*given, *given == LengthUnit::metre ? "" : "--unit"}
                          : tell_unit(scans, paths, context);
    if (unit.unit == LengthUnit::metre) return unit;
    for (Scan& scan : scans)
        scale_in_place(scan.cloud, metres_per(unit.unit));
    return unit;
}

void convert_to_metres(std::span<std::optional<Transform>> poses, const ScanUnit& unit) {
    for (std::optional<Transform>& pose : poses) {
        if (pose) pose->translation() *= metres_per(unit.unit);
    }
}

std::optional<DerivedValue> unit_as_derived_value(const ScanUnit& unit) {
    if (unit.unit == LengthUnit::metre) return std::nullopt;
    return DerivedValue{
        "input.length_unit", metres_per(unit.unit), "m",
        fmt::format("the scans are in {}: {}", length_unit_word(unit.unit), unit.reason)};
}

std::string doubt_about_feet(const Reconstruction& reconstruction) {
    const Scene& scene = reconstruction.scene;
    std::vector<double> heights;
    for (const MapSection& section : reconstruction.map.sections) {
        if (section.sensor_position)
            heights.push_back((scene.room_from_map * *section.sensor_position).z());
    }
    if (!may_be_feet(scene.rooms, heights)) return "";
    const Room& room = scene.rooms.front();
    return fmt::format("{} is {:.1f} m high: if the scans are in feet, run with --unit ft", room.id,
                       room.ceiling_height - room.floor_height);
}

}  // namespace roomscribe::cli
