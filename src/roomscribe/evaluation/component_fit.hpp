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

/// True if two components without a point to compare are about one thing: their polygons overlap as
/// rectangle_iou has it, by half, or the centre of the detected box lies in the true one.
bool lie_in_one_place(const Component& of_truth, const Component& detected);

/// Centre of a component's box, else of its polygon's corners, else where it is grasped.
std::optional<Eigen::Vector3d> component_center(const Component& component);

}  // namespace roomscribe
