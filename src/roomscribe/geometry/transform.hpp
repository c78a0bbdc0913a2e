// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Geometry>

namespace roomscribe {

/// A rigid motion, named `target_from_source`: x_target = target_from_source * x_source.
using Transform = Eigen::Isometry3d;

/// Angle of the rotation in [0, pi]. Accurate near 0 and near pi.
double rotation_angle(const Eigen::Matrix3d& rotation);

/// The rotation nearest to a matrix that has drifted from one (polar decomposition by SVD).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

/// Where the mass of some points lies: enough to say how far two motions take them apart.
struct PointSpread {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Mean and covariance of the points; zero if there are none.
PointSpread measure_spread(std::span<const Eigen::Vector3f> points);

/// Root mean square over the points of the distance between a * x and b * x.
double rms_displacement(const PointSpread& spread, const Transform& a, const Transform& b);

/// The motion for a small twist (rotation vector, then translation): rotation by the exponential
/// map, translation as it stands.
Transform transform_from_twist(const Eigen::Matrix<double, 6, 1>& twist);

}  // namespace roomscribe
