// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// The pose moved along each twist, both ways, so that the source's points move by the distance and
/// by twice the distance (m, root mean square; of small turns exactly). Twists are those of
/// PoseCovariance::unobservable; one that moves nothing is left out.
std::vector<Transform> slide_pose(const PointSpread& source, const Transform& target_from_source,
                                  std::span<const Eigen::Matrix<double, 6, 1>> twists,
                                  double distance);

}  // namespace roomscribe
