// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace roomscribe {

/// The points x with normal . x = offset; the normal has unit length.
struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    double offset = 0.0;

    double signed_distance(const Eigen::Vector3d& point) const {
        return normal.dot(point) - offset;
    }
    Eigen::Vector3d project(const Eigen::Vector3d& point) const {
        return point - signed_distance(point) * normal;
    }
    Plane flipped() const { return {-normal, -offset}; }
};

/// Two unit vectors that complete `normal` to a right-handed frame (u x v = normal). They depend on
/// the normal alone.
struct PlaneAxes {
    Eigen::Vector3d u;
    Eigen::Vector3d v;
};
PlaneAxes plane_axes(const Eigen::Vector3d& normal);

struct PlaneFit {
    Plane plane;
    Eigen::Vector3d centroid;
    double rms = 0.0;  ///< root mean square distance of the points to the plane
    /// Variances of the points along the three principal directions, ascending.
    Eigen::Vector3d variances;
};

/// Least-squares plane through points (total least squares by principal components). Empty if fewer
/// than 3 points are given or all lie on one line. The normal's sign is arbitrary but fixed.
std::optional<PlaneFit> fit_plane(std::span<const Eigen::Vector3f> points);
std::optional<PlaneFit> fit_plane(std::span<const Eigen::Vector3f> points,
                                  std::span<const std::uint32_t> indices);

/// Sums from which a plane is fitted without keeping the points.
struct PlaneMoments {
    std::size_t count = 0;
    Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< sums are taken relative to it
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d sum_of_squares = Eigen::Matrix3d::Zero();

    void add(const Eigen::Vector3d& point);
    PlaneMoments& operator+=(const PlaneMoments& other);
    std::optional<PlaneFit> fit() const;
};

}  // namespace roomscribe
