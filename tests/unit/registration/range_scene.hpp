// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "roomscribe/core/units.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"

namespace roomscribe::test {

inline constexpr double scene_resolution = radians(0.5);

inline RangeImageSettings scene_settings() {
    return {.angular_resolution = scene_resolution};
}

/// A scan from the origin along x, one ray through the middle of each pixel up to 30 degrees from
/// the axis both ways; `range_along(direction)` is NaN for a ray without return.
template <typename RangeAlong>
Scan scan_scene(RangeAlong&& range_along) {
    RangeProjection projection;
    projection.first_x = -std::numbers::pi;
    projection.first_y = -std::numbers::pi / 2.0;
    projection.step_x = projection.step_y = scene_resolution;
    projection.cloud_from_polar << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    Scan scan;
    for (int y = 120; y <= 240; ++y) {
        for (int x = 300; x <= 420; ++x) {
            const Eigen::Vector3d direction = projection.direction(x, y);
            const double range = range_along(direction);
            if (range > 0.0) scan.cloud.positions.emplace_back((range * direction).cast<float>());
        }
    }
    return scan;
}

inline double range_to_wall(const Eigen::Vector3d& direction, double distance = 4.0) {
    return distance / direction.x();
}

/// A panel with its middle on the x axis, before a wall.
inline Scan panel_scene(double half_width = 0.5, double half_height = 0.5) {
    return scan_scene([=](const Eigen::Vector3d& direction) {
        constexpr double panel_distance = 2.0;
        const Eigen::Vector3d hit = range_to_wall(direction, panel_distance) * direction;
        const bool is_panel = std::abs(hit.y()) < half_width && std::abs(hit.z()) < half_height;
        return range_to_wall(direction, is_panel ? panel_distance : 4.0);
    });
}

inline Scan wall_scene() {
    return scan_scene([](const Eigen::Vector3d& direction) { return range_to_wall(direction); });
}

/// The pixel that looks at a point.
inline std::uint32_t pixel_at(const RangeImage& image, const Eigen::Vector3d& point) {
    const Eigen::Vector2d pixel =
        image.projection.pixel(point - image.sensor_position.cast<double>());
    return static_cast<std::uint32_t>(image.index(static_cast<int>(std::lround(pixel.x())),
                                                  static_cast<int>(std::lround(pixel.y()))));
}

}  // namespace roomscribe::test
