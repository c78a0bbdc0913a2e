// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <ostream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/transform.hpp"

namespace roomscribe::test {

/// A rigid motion that differs from `expected` by at most so many metres and radians.
MATCHER_P3(TransformNear, expected, max_distance, max_angle, "") {
    const double distance = (arg.translation() - expected.translation()).norm();
    const Eigen::Matrix3d turn = expected.linear().transpose() * arg.linear();
    const double angle = rotation_angle(turn);
    *result_listener << "off by " << distance << " m and " << degrees(angle) << " degrees";
    // A reflection has no angle that rotation_angle could tell.
    return turn.determinant() > 0.0 && distance <= max_distance && angle <= max_angle;
}

/// A vector all of whose coordinates are within `tolerance` of those of `expected`.
MATCHER_P2(VectorNear, expected, tolerance, "") {
    const double off = (arg - expected).cwiseAbs().maxCoeff();
    *result_listener << "off by " << off;
    return off <= static_cast<double>(tolerance);
}

}  // namespace roomscribe::test
