// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/structure/plane_detection.hpp"

namespace roomscribe {

struct PlaneHoughSettings {
    PlaneDetectionSettings detection;
    double angle_step = radians(2.0);

    void visit(SettingVisitor& visitor) {
        detection.visit(visitor);
        visitor(angle_step, {.name = "angle_step",
                             .unit = "rad",
                             .min = 0.005,
                             .max = 0.5,
                             .doc = "Distance of neighbouring directions of the accumulator."});
    }
};

/// Planes one after another by the Hough transform, the paper's stated future work: it draws no
/// lots. Evenly spread voters, at most some ten thousand, vote with all points that they stand for,
/// for all planes of an accumulator: directions evenly spread over the half-sphere times offsets.
/// The cells with the most votes are refined by least squares over their inliers until these
/// settle, and the one with the most inliers of all points is taken out (take_out_planes). Normals
/// are not needed. The cloud's order does not matter but for ties.
PlaneDetectionResult detect_planes_hough(const PointCloud& cloud,
                                         const PlaneHoughSettings& settings = {},
                                         const Context& context = {});

}  // namespace roomscribe
