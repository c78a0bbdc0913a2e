// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace roomscribe {

/// A straight piece between two points, in metres.
struct LineSegment {
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    Eigen::Vector3d end = Eigen::Vector3d::Zero();

    double length() const { return (end - start).norm(); }
    /// Unit vector from start to end; NaN for a segment without length.
    Eigen::Vector3d direction() const { return (end - start) / length(); }
};

}  // namespace roomscribe
