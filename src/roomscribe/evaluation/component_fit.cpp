// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/component_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "roomscribe/evaluation/polygon_overlap.hpp"
#include "roomscribe/evaluation/protocol.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

Eigen::Vector3d center_of(const Corners& corners) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : corners)
        sum += corner;
    return sum / static_cast<double>(corners.size());
}

/// Along the normal, as long as twice the area (Newell).
Eigen::Vector3d area_vector(const Corners& corners) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (corners.size() < 3) return sum;
    const Eigen::Vector3d center = center_of(corners);
    for (std::size_t i = 0; i < corners.size(); ++i)
        sum += (corners[i] - center).cross(corners[(i + 1) % corners.size()] - center);
    return sum;
}

}  // namespace

std::optional<PolygonOverlap> overlap_of_polygons(const Corners& true_corners,
                                                  const Corners& detected_corners,
                                                  double max_distance) {
    const std::optional<Plane> true_plane = plane_of_polygon(true_corners);
    const std::optional<Plane> detected_plane = plane_of_polygon(detected_corners);
    if (!true_plane || !detected_plane) return std::nullopt;
    // Which way round the corners run says nothing.
    const double sine = true_plane->normal.cross(detected_plane->normal).norm();
    const double cosine = std::abs(true_plane->normal.dot(detected_plane->normal));
    const double distance = std::abs(true_plane->signed_distance(center_of(detected_corners)));
    if (std::atan2(sine, cosine) > protocol::max_normal_angle + protocol::rounding ||
        distance > max_distance + protocol::rounding) {
        return std::nullopt;
    }
    const PlaneAxes axes = plane_axes(true_plane->normal);
    const auto flattened = [&](const Corners& corners) {
        std::vector<Eigen::Vector2d> flat;
        for (const Eigen::Vector3d& corner : corners) {
            const Eigen::Vector3d offset = corner - true_corners.front();
            flat.emplace_back(axes.u.dot(offset), axes.v.dot(offset));
        }
        return flat;
    };
    const std::vector<Eigen::Vector2d> of_truth = flattened(true_corners);
    const std::vector<Eigen::Vector2d> detected = flattened(detected_corners);
    return PolygonOverlap{overlap_area(of_truth, detected), std::abs(signed_area(of_truth)),
                          std::abs(signed_area(detected))};
}

std::optional<Plane> plane_of_polygon(const Corners& corners) {
    const Eigen::Vector3d normal = area_vector(corners);
    if (!(normal.norm() > 1e-12)) return std::nullopt;
    return Plane{normal.normalized(), normal.normalized().dot(center_of(corners))};
}

double polygon_area(const Corners& corners) {
    return area_vector(corners).norm() / 2.0;
}

std::optional<double> rectangle_iou(const Corners& true_corners, const Corners& detected_corners) {
    const std::optional<PolygonOverlap> overlap =
        overlap_of_polygons(true_corners, detected_corners, protocol::max_plane_distance);
    if (!overlap) return std::nullopt;
    const double together = overlap->true_area + overlap->detected_area - overlap->shared;
    return together > 0.0 ? std::clamp(overlap->shared / together, 0.0, 1.0) : 0.0;
}

bool lie_in_one_place(const Component& of_truth, const Component& detected) {
    if (!of_truth.polygon.empty() && !detected.polygon.empty()) {
        return rectangle_iou(of_truth.polygon, detected.polygon).value_or(0.0) >=
               protocol::min_iou - protocol::rounding;
    }
    if (!of_truth.box || !detected.box) return false;
    const Eigen::Vector3d offset = detected.box->center - of_truth.box->center;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d& direction = of_truth.box->axes[static_cast<std::size_t>(axis)];
        if (std::abs(direction.dot(offset)) > of_truth.box->size(axis) / 2.0) return false;
    }
    return true;
}

std::optional<Eigen::Vector3d> component_center(const Component& component) {
    if (component.box) return component.box->center;
    if (!component.polygon.empty()) return center_of(component.polygon);
    if (component.grasp) return component.grasp->position;
    return std::nullopt;
}

}  // namespace roomscribe
