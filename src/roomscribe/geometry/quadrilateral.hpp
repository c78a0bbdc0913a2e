// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include <Eigen/Core>

namespace roomscribe {

/// Four corners in order around, on one plane, in metres.
struct Quadrilateral {
    std::array<Eigen::Vector3d, 4> corners{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                           Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};

    Eigen::Vector3d center() const {
        return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    }
};

}  // namespace roomscribe
