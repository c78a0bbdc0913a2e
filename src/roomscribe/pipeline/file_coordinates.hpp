// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

// Clouds in memory are shifted where their coordinates are far (PointCloud::global_shift); files
// hold the coordinates as they are.

/// A pose between the coordinates of two clouds in memory, for their coordinates in files.
Transform in_file_coordinates(const Transform& target_from_source,
                              const Eigen::Vector3d& target_shift,
                              const Eigen::Vector3d& source_shift);

/// A scene of a map in memory, for the map's coordinates in files. The negative shift goes back.
Scene in_file_coordinates(Scene scene, const Eigen::Vector3d& shift);

}  // namespace roomscribe
