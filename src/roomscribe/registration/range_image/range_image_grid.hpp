// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"

namespace roomscribe {

/// Fills an image, whose axes and sensor position are set, from the cloud's grid: a pixel is a ray,
/// or the nearest of as many rays as make up `angular_resolution`. Leaves the image as it is and
/// returns false if there is no grid, or its rays do not keep even steps of longitude and latitude
/// about any of the scanner's axes.
bool fill_from_grid(RangeImage& image, const PointCloud& cloud,
                    std::optional<double> angular_resolution);

}  // namespace roomscribe
