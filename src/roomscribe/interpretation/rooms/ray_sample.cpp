// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/ray_sample.hpp"

#include <cmath>

namespace roomscribe {

using Eigen::Vector3f;

std::vector<Ray> sample_rays(const ScanMap& map, std::size_t max_rays) {
    std::vector<Ray> rays;
    const std::size_t stride = map.cloud.size() / max_rays + 1;
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position) continue;
        const Vector3f origin = section.sensor_position->cast<float>();
        for (std::size_t i = section.first; i < section.first + section.count; i += stride) {
            const Vector3f& end = map.cloud.positions[i];
            if (end.allFinite()) rays.push_back({origin, end});
        }
    }
    return rays;
}

RayCount count_rays(std::span<const Ray> rays, const UprightWindow& window, double tolerance) {
    const Vector3f normal = window.plane.normal.cast<float>();
    const auto offset = static_cast<float>(window.plane.offset);
    const Vector3f along = window.along.cast<float>();
    const Vector3f up = window.up.cast<float>();
    const auto reach = static_cast<float>(tolerance);
    RayCount count;
    for (const Ray& ray : rays) {
        const float before = normal.dot(ray.origin) - offset;
        const float behind = offset - normal.dot(ray.end);
        if (before <= 2.0F * reach || behind < -reach) continue;
        const Vector3f place = ray.origin + before / (before + behind) * (ray.end - ray.origin);
        const auto x = static_cast<double>(along.dot(place));
        const auto z = static_cast<double>(up.dot(place));
        if (x < window.start || x > window.end || z < window.bottom || z > window.top) continue;
        ++(behind > reach ? count.passed : count.ended);
    }
    return count;
}

}  // namespace roomscribe
