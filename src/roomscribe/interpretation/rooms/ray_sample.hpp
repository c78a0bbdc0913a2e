// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// From a scanner to what it saw.
struct Ray {
    Eigen::Vector3f origin;
    Eigen::Vector3f end;
};

/// An even share of the rays of all scanners whose places are known, at most about `max_rays` of
/// them. Lost returns and points that are not finite have none.
std::vector<Ray> sample_rays(const ScanMap& map, std::size_t max_rays);

/// A rectangle on an upright plane: m along a level direction within it and along up.
struct UprightWindow {
    Plane plane;
    Eigen::Vector3d along = Eigen::Vector3d::UnitX();
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    double start = 0.0;
    double end = 0.0;
    double bottom = 0.0;
    double top = 0.0;
};

/// What became of the rays that met a rectangle from the side its normal looks to.
struct RayCount {
    std::size_t ended = 0;   ///< within `tolerance` of it
    std::size_t passed = 0;  ///< and ended farther behind it
};
RayCount count_rays(std::span<const Ray> rays, const UprightWindow& window, double tolerance);

}  // namespace roomscribe
