// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/transform.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

namespace roomscribe {

double rotation_angle(const Eigen::Matrix3d& rotation) {
    const Eigen::Quaterniond quaternion(rotation);
    return 2.0 * std::atan2(quaternion.vec().norm(), std::abs(quaternion.w()));
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) *= -1.0;
    return u * svd.matrixV().transpose();
}

PointSpread measure_spread(std::span<const Eigen::Vector3f> points) {
    PointSpread spread;
    if (points.empty()) return spread;
    const auto count = static_cast<double>(points.size());
    for (const Eigen::Vector3f& point : points)
        spread.mean += point.cast<double>();
    spread.mean /= count;
    for (const Eigen::Vector3f& point : points) {
        const Eigen::Vector3d offset = point.cast<double>() - spread.mean;
        spread.covariance.noalias() += offset * offset.transpose();
    }
    spread.covariance /= count;
    return spread;
}

double rms_displacement(const PointSpread& spread, const Transform& a, const Transform& b) {
    const Eigen::Matrix3d turn = a.linear() - b.linear();
    const double about_mean = (turn * spread.covariance * turn.transpose()).trace();
    return std::sqrt(std::max(0.0, about_mean) + (a * spread.mean - b * spread.mean).squaredNorm());
}

Transform transform_from_twist(const Eigen::Matrix<double, 6, 1>& twist) {
    const Eigen::Vector3d rotation = twist.head<3>();
    const double angle = rotation.norm();
    Transform transform = Transform::Identity();
    if (angle > 0.0) {
        transform.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
    }
    transform.translation() = twist.tail<3>();
    return transform;
}

}  // namespace roomscribe
