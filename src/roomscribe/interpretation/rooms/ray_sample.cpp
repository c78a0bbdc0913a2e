// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/ray_sample.hpp"

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
    const auto reach = static_cast<float>(tolerance);
    RayCount count;
    visit_rays(rays, window, [&](const Ray&, float behind) {
        if (behind >= -reach) ++(behind > reach ? count.passed : count.ended);
    });
    return count;
}

}  // namespace roomscribe
