// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

struct PlaneHoughSettings {
    double distance_tolerance = 0.03;
    int min_inliers = 2500;
    int max_planes = 1000;
    double angle_step = radians(2.0);

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
        visitor(angle_step, {.name = "angle_step",
                             .unit = "rad",
                             .min = 0.005,
                             .max = 0.5,
                             .doc = "Distance of neighbouring directions of the accumulator."});
    }
};

enum class PlaneHoughStop : std::uint8_t {
    few_points_left,   ///< points left < min_inliers
    few_inliers_left,  ///< inliers of the best plane left < min_inliers
    max_planes         ///< planes found = max_planes
};

struct PlaneHoughResult {
    std::vector<PlanarPatch> planes;  ///< in the order found: about the largest first
    std::vector<std::uint32_t> remaining_points;
    PlaneHoughStop stop = PlaneHoughStop::few_points_left;
};

/// Planes one after another by the Hough transform, the paper's stated future work: it draws no
/// lots. Evenly spread voters, at most some ten thousand, vote with all points that they stand for,
/// for all planes of an accumulator: directions evenly spread over the half-sphere times offsets.
/// The cells with the most votes are refined by least squares over their inliers until these
/// settle, and the one with the most inliers of all points is taken out, until fewer than
/// `min_inliers` are left or found. As in detect_planes_ransac, each is one patch whether or not it
/// is connected, points that are not finite are left out, and normals are not needed. The cloud's
/// order does not matter but for ties.
PlaneHoughResult detect_planes_hough(const PointCloud& cloud,
                                     const PlaneHoughSettings& settings = {},
                                     const Context& context = {});

}  // namespace roomscribe
