// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

/// What the detectors have in common that take planes out one after another.
struct PlaneDetectionSettings {
    double distance_tolerance = 0.03;
    int min_inliers = 2500;
    int max_planes = 1000;

    void visit(SettingVisitor& visitor) {
        visitor(distance_tolerance, {.name = "distance_tolerance",
                                     .unit = "m",
                                     .min = 1e-9,
                                     .max = 1e6,
                                     .doc = "An inlier lies no further from the plane."});
        visitor(min_inliers, {.name = "min_inliers",
                              .unit = "",
                              .min = 3,
                              .max = 1e9,
                              .doc = "Fewest inliers of a plane (the paper's 2,500)."});
        visitor(max_planes, {.name = "max_planes",
                             .unit = "",
                             .min = 1,
                             .max = 1e6,
                             .doc = "Most planes that are looked for."});
    }
};

enum class PlaneDetectionStop : std::uint8_t {
    few_points_left,   ///< points left < min_inliers
    few_inliers_left,  ///< inliers of the best plane left < min_inliers
    max_planes         ///< planes found = max_planes
};

struct PlaneDetectionResult {
    std::vector<PlanarPatch> planes;  ///< in the order found: about the largest first
    std::vector<std::uint32_t> remaining_points;
    PlaneDetectionStop stop = PlaneDetectionStop::few_points_left;
};

/// The best plane among the points that are left, if there is any.
using FindPlane = std::function<std::optional<Plane>(std::span<const std::uint32_t> left)>;

/// The loop of the paper's section 4.2: a plane is found, its inliers are taken out, until fewer
/// than `min_inliers` are left or found. Each plane is one patch whether or not it is connected.
/// Points that are not finite are left out.
PlaneDetectionResult take_out_planes(const PointCloud& cloud, const FindPlane& find_plane,
                                     const PlaneDetectionSettings& settings,
                                     const Context& context);

}  // namespace roomscribe
