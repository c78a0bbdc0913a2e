// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_detection.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace roomscribe {

PlaneDetectionResult take_out_planes(const PointCloud& cloud, const FindPlane& find_plane,
                                     const PlaneDetectionSettings& settings,
                                     const Context& context) {
    PlaneDetectionResult result;
    std::vector<std::uint32_t> left = finite_points(cloud);
    const auto min_inliers = static_cast<std::size_t>(settings.min_inliers);
    while (left.size() >= min_inliers) {
        context.throw_if_cancelled();
        if (result.planes.size() == static_cast<std::size_t>(settings.max_planes)) {
            result.stop = PlaneDetectionStop::max_planes;
            break;
        }
        std::vector<std::uint32_t> inliers;
        std::vector<std::uint32_t> rest;
        const std::optional<Plane> plane = find_plane(left);
        if (plane) {
            std::partition_copy(left.begin(), left.end(), std::back_inserter(inliers),
                                std::back_inserter(rest), [&](std::uint32_t point) {
                                    return std::abs(plane->signed_distance(
                                               cloud.positions[point].cast<double>())) <=
                                           settings.distance_tolerance;
                                });
        }
        if (inliers.size() < min_inliers) {
            result.stop = PlaneDetectionStop::few_inliers_left;
            break;
        }
        result.planes.push_back(make_planar_patch(cloud, *plane, std::move(inliers)));
        left = std::move(rest);
    }
    result.remaining_points = std::move(left);
    return result;
}

}  // namespace roomscribe
