// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/interpretation/rooms/wall_rectangle.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// From a scanner to what it saw.
struct Ray {
    Eigen::Vector3f origin;
    Eigen::Vector3f end;
};

/// An even share of the rays of all scanners whose places are known, at most about `max_rays` of
/// them. Lost returns and points that are not finite have none.
std::vector<Ray> sample_rays(const ScanMap& map, std::size_t max_rays = 400'000);

/// A part of an upright plane that rays are aimed at.
struct UprightWindow {
    Plane plane;
    Eigen::Vector3d along = Eigen::Vector3d::UnitX();  ///< level, within the plane
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    WallRectangle extent;
};

/// Calls `visit(ray, behind)` for each ray that meets the rectangle from the side its normal looks
/// to; `behind`: m behind its plane, at which the ray ended (less than 0: before it).
template <typename Visit>
void visit_rays(std::span<const Ray> rays, const UprightWindow& window, Visit&& visit) {
    const Eigen::Vector3f normal = window.plane.normal.cast<float>();
    const auto offset = static_cast<float>(window.plane.offset);
    const Eigen::Vector3f along = window.along.cast<float>();
    const Eigen::Vector3f up = window.up.cast<float>();
    for (const Ray& ray : rays) {
        const float before = normal.dot(ray.origin) - offset;
        const float behind = offset - normal.dot(ray.end);
        if (before <= 0.0F || before + behind <= 0.0F) continue;
        const Eigen::Vector3f place =
            ray.origin + before / (before + behind) * (ray.end - ray.origin);
        const auto x = static_cast<double>(along.dot(place));
        const auto z = static_cast<double>(up.dot(place));
        const WallRectangle& extent = window.extent;
        if (x < extent.start || x > extent.end || z < extent.bottom || z > extent.top) continue;
        visit(ray, behind);
    }
}

/// What became of the rays that met a rectangle from the side its normal looks to.
struct RayCount {
    std::size_t ended = 0;   ///< within `tolerance` of it
    std::size_t passed = 0;  ///< and ended farther behind it
};
RayCount count_rays(std::span<const Ray> rays, const UprightWindow& window, double tolerance);

}  // namespace roomscribe
