// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/paper_rules/room_by_pass_through.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Share of the points at either end of a direction that do not count: strays that happen to lie on
/// a plane far off.
constexpr double stray_share = 0.01;

struct Range {
    double low = 0.0;
    double middle = 0.0;
    double high = 0.0;
};

Range range_along(const PointCloud& map, std::span<const std::uint32_t> points,
                  const Vector3d& direction) {
    std::vector<double> positions;
    positions.reserve(points.size());
    for (const std::uint32_t point : points)
        positions.push_back(direction.dot(map.positions[point].cast<double>()));
    Range range;
    range.low = quantile(positions, stray_share);
    range.middle = quantile(positions, 0.5);
    range.high = quantile(positions, 1.0 - stray_share);
    return range;
}

std::vector<std::uint32_t> points_of(std::span<const PlanarPatch> planes) {
    std::vector<std::uint32_t> points;
    for (const PlanarPatch& plane : planes)
        points.insert(points.end(), plane.points.begin(), plane.points.end());
    return points;
}

double mean_height(std::span<const PlanarPatch> planes, std::span<const std::uint32_t> numbers,
                   const Vector3d& up) {
    double sum = 0.0;
    double count = 0.0;
    for (const std::uint32_t number : numbers) {
        const auto weight = static_cast<double>(planes[number].points.size());
        sum += weight * planes[number].centroid.dot(up);
        count += weight;
    }
    return sum / count;
}

}  // namespace

RuleRoom find_room_by_pass_through(const PointCloud& map, std::span<const PlanarPatch> planes,
                                   const Eigen::Matrix3d& room_from_map,
                                   const PaperRulesSettings& settings) {
    check_settings(settings);
    RuleRoom room;
    if (planes.empty()) return room;
    const Vector3d up = room_from_map.row(2).transpose();
    const double min_cosine = std::cos(settings.angle_tolerance);
    const std::vector<std::uint32_t> all = points_of(planes);
    const Range heights = range_along(map, all, up);
    room.bottom = heights.low;
    room.top = heights.high;
    const double least_height = (1.0 - settings.size_tolerance) * settings.wall_height;

    for (std::uint32_t number = 0; number < planes.size(); ++number) {
        const PlanarPatch& plane = planes[number];
        if (std::abs(plane.plane.normal.dot(up)) < min_cosine) continue;
        const double height = plane.centroid.dot(up);
        if (height <= heights.low + settings.slice_height) {
            room.floor.push_back(number);
        } else if (height >= heights.high - settings.slice_height &&
                   height - heights.low >= least_height) {
            room.ceiling.push_back(number);
        }
    }
    if (!room.floor.empty()) room.floor_height = mean_height(planes, room.floor, up);
    if (!room.ceiling.empty()) room.ceiling_height = mean_height(planes, room.ceiling, up);

    Vector3d middle;
    for (const Eigen::Index axis : {0, 1, 2})
        middle[axis] = range_along(map, all, room_from_map.row(axis).transpose()).middle;
    middle = room_from_map.transpose() * middle;

    for (std::uint32_t number = 0; number < planes.size(); ++number) {
        const PlanarPatch& plane = planes[number];
        const Vector3d turned = (room_from_map * plane.plane.normal).cwiseAbs();
        if (std::max(turned.x(), turned.y()) < min_cosine) continue;  // rule (i)
        RuleWall wall;
        wall.plane = number;
        wall.face = plane.plane.signed_distance(middle) < 0.0 ? plane.plane.flipped() : plane.plane;
        wall.along = up.cross(wall.face.normal).normalized();
        const Range along = range_along(map, plane.points, wall.along);
        const Range upwards = range_along(map, plane.points, up);
        const bool is_wall = room.ceiling_height
                                 ? upwards.high >= *room.ceiling_height - settings.slice_height
                                 : upwards.high - upwards.low >= least_height;
        if (!is_wall) continue;
        wall.extent = {along.low, along.high, room.floor_height.value_or(upwards.low),
                       room.ceiling_height.value_or(upwards.high)};
        room.walls.push_back(wall);
    }
    return room;
}

}  // namespace roomscribe
