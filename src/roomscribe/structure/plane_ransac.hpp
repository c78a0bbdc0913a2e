// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/geometry/sample_consensus.hpp"
#include "roomscribe/structure/plane_detection.hpp"

namespace roomscribe {

struct PlaneRansacSettings {
    PlaneDetectionSettings detection;
    int max_scored_points = 50'000;
    ConsensusSettings consensus;

    void visit(SettingVisitor& visitor) {
        detection.visit(visitor);
        visitor(max_scored_points,
                {.name = "max_scored_points",
                 .unit = "",
                 .min = 3,
                 .max = 1e9,
                 .doc = "Of more points, drawn planes are held against an even share of this size, "
                        "which tells the share of inliers to a quarter of a per cent."});
        visitor.group("consensus", consensus);
    }
};

/// Planes one after another by RANSAC, as in the paper's section 4.2: take_out_planes, each time
/// the plane with the most inliers, in an even share of the points where these are many. Normals
/// are not needed; where there are any, they decide the sign of the plane's.
PlaneDetectionResult detect_planes_ransac(const PointCloud& cloud, std::uint64_t seed,
                                          const PlaneRansacSettings& settings = {},
                                          const Context& context = {});

}  // namespace roomscribe
