// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/false_returns.hpp"

#include <limits>

#include "roomscribe/preprocessing/saturated_returns.hpp"
#include "roomscribe/preprocessing/stray_returns.hpp"

namespace roomscribe {
namespace {

void blank(std::span<Eigen::Vector3f> positions, const std::vector<std::uint32_t>& numbers) {
    for (const std::uint32_t i : numbers)
        positions[i].setConstant(std::numeric_limits<float>::quiet_NaN());
}

/// Makes the false returns NaN; the first point has this number.
std::vector<HiddenPoint> hide(std::span<Eigen::Vector3f> positions, const Eigen::Vector3d& sensor,
                              std::uint32_t first_number, const Context& context) {
    std::vector<HiddenPoint> hidden;
    const auto hide_all = [&](const std::vector<std::uint32_t>& numbers) {
        for (const std::uint32_t i : numbers)
            hidden.push_back({first_number + i, positions[i]});
        blank(positions, numbers);
    };
    // A shell at the end of the range would be dense enough to be a surface.
    hide_all(find_saturated_returns(positions, sensor));
    hide_all(find_stray_returns(positions, sensor, context));
    return hidden;
}

}  // namespace

std::optional<Scan> without_false_returns(const Scan& scan, const Context& context) {
    const Eigen::Vector3d sensor = scan.sensor_position();
    const std::vector<std::uint32_t> saturated =
        find_saturated_returns(scan.cloud.positions, sensor);
    std::vector<std::uint32_t> strays;
    if (saturated.empty()) {
        strays = find_stray_returns(scan.cloud.positions, sensor, context);
        // Most scans have none and are not copied.
        if (strays.empty()) return std::nullopt;
    }
    std::vector<Eigen::Vector3f> positions = scan.cloud.positions;
    blank(positions, saturated);
    if (!saturated.empty()) strays = find_stray_returns(positions, sensor, context);
    blank(positions, strays);
    Scan rest;
    rest.name = scan.name;
    rest.cloud.positions = std::move(positions);
    rest.cloud.normals = scan.cloud.normals;
    rest.cloud.grid = scan.cloud.grid;
    rest.cloud.sensor_pose = scan.cloud.sensor_pose;
    rest.cloud.global_shift = scan.cloud.global_shift;
    return rest;
}

std::vector<HiddenPoint> hide_false_returns(ScanMap& map, const Context& context) {
    std::vector<HiddenPoint> hidden;
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position) continue;
        const auto of_section =
            std::span(map.cloud.positions).subspan(section.first, section.count);
        const std::vector<HiddenPoint> some =
            hide(of_section, *section.sensor_position, section.first, context);
        hidden.insert(hidden.end(), some.begin(), some.end());
    }
    return hidden;
}

void put_back(std::span<const HiddenPoint> hidden, ScanMap& map) {
    for (const HiddenPoint& point : hidden)
        map.cloud.positions[point.number] = point.position;
}

}  // namespace roomscribe
