// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/geometry/sample_consensus.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

struct PlaneRansacSettings {
    double distance_tolerance = 0.03;
    int min_inliers = 2500;
    int max_planes = 1000;
    ConsensusSettings consensus;

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
        visitor.group("consensus", consensus);
    }
};

enum class PlaneRansacStop : std::uint8_t {
    few_points_left,   ///< points left < min_inliers
    few_inliers_left,  ///< inliers of the best plane left < min_inliers
    max_planes         ///< planes found = max_planes
};

struct PlaneRansacResult {
    std::vector<PlanarPatch> planes;  ///< in the order found: about the largest first
    std::vector<std::uint32_t> remaining_points;
    PlaneRansacStop stop = PlaneRansacStop::few_points_left;
};

/// Planes one after another by RANSAC, as in the paper's section 4.2: the plane with the most
/// inliers is fitted and its inliers are taken out, until fewer than `min_inliers` are left or
/// found. Each is one patch whether or not it is connected. Points that are not finite are left
/// out. Normals are not needed; where there are any, they decide the sign of the plane's.
PlaneRansacResult detect_planes_ransac(const PointCloud& cloud, std::uint64_t seed,
                                       const PlaneRansacSettings& settings = {},
                                       const Context& context = {});

}  // namespace roomscribe
