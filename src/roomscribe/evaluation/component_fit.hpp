// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// What two planar polygons share, m2, seen along the normal of the true one.
struct PolygonOverlap {
    double shared = 0.0;
    double true_area = 0.0;
    double detected_area = 0.0;  ///< as projected
};

/// Empty if their planes are turned more than the protocol allows, the centre of the detected
/// corners is farther than `max_distance` (m) from the true plane, or one is no polygon.
std::optional<PolygonOverlap> overlap_of_polygons(
    const std::vector<Eigen::Vector3d>& true_corners,
    const std::vector<Eigen::Vector3d>& detected_corners, double max_distance);

/// Plane through the corners' centre; empty if they enclose no area.
std::optional<Plane> plane_of_polygon(const std::vector<Eigen::Vector3d>& corners);

/// Area that a planar polygon encloses, m2; 0 for fewer than 3 corners.
double polygon_area(const std::vector<Eigen::Vector3d>& corners);

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
