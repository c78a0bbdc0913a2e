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
    ConsensusSettings consensus;

    void visit(SettingVisitor& visitor) {
        detection.visit(visitor);
        visitor.group("consensus", consensus);
    }
};

/// Planes one after another by RANSAC, as in the paper's section 4.2: take_out_planes, each time
/// the plane with the most inliers. Normals are not needed; where there are any, they decide the
/// sign of the plane's.
PlaneDetectionResult detect_planes_ransac(const PointCloud& cloud, std::uint64_t seed,
                                          const PlaneRansacSettings& settings = {},
                                          const Context& context = {});

}  // namespace roomscribe
