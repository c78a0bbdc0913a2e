// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// IoU of two planar polygons, the detected one projected onto the true plane; empty if their
/// planes are farther apart or turned more than the protocol allows, or one is no polygon.
std::optional<double> rectangle_iou(const std::vector<Eigen::Vector3d>& true_corners,
                                    const std::vector<Eigen::Vector3d>& detected_corners);

/// Centre of a component's box, else of its polygon's corners, else where it is grasped.
std::optional<Eigen::Vector3d> component_center(const Component& component);

}  // namespace roomscribe
