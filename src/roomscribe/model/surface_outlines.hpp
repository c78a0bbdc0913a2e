// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// A planar patch of the map with its rims, in the map's frame: what the paper's Fig. 3 shows.
struct OutlinedPatch {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< to the scanner, where that is known
    std::vector<Eigen::Vector3f> points;               ///< of an even sample of the surface
    std::vector<Eigen::Vector3f> boundary;             ///< its rim points, of holes too
    std::vector<std::array<Eigen::Vector3f, 2>> lines;
    std::vector<std::array<Eigen::Vector3f, 4>> rectangles;
};

}  // namespace roomscribe
