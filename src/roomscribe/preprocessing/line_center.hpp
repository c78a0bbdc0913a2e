// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Where the scanner of a cloud in scan order stood, in the cloud's frame: the one place from which
/// the rays of each line of the grid lie in a plane and turn by equal steps. Robots write their
/// clouds in the frame of their base, with the laser up to a metre above it.
///
/// The planes of all lines of a tilting or turning laser share its axis of turning; where along it
/// the scanner stood, and how far from it, is told by the steps. Points at exactly zero count as no
/// return. Empty without a grid, with fewer than 8 lines of 50 points, where the lines are not
/// plane or their planes parallel (a resampled surface), and where the steps are not alike.
std::optional<Eigen::Vector3d> find_line_center(const PointCloud& cloud);

/// Gives a scan in scan order that does not say where it was seen from the sensor pose that its
/// lines tell, turned as the scan's frame is. Whether it did.
bool locate_scanner(Scan& scan);

}  // namespace roomscribe
