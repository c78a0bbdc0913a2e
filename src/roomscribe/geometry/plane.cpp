// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/plane.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace roomscribe {

PlaneAxes plane_axes(const Eigen::Vector3d& normal) {
    // The coordinate axis that is least parallel to the normal gives a well-conditioned frame.
    Eigen::Index smallest = 0;
    normal.cwiseAbs().minCoeff(&smallest);
    const Eigen::Vector3d u = normal.cross(Eigen::Vector3d::Unit(smallest)).normalized();
    return {u, normal.cross(u)};
}

void PlaneMoments::add(const Eigen::Vector3d& point) {
    if (count == 0) reference = point;
    const Eigen::Vector3d offset = point - reference;
    ++count;
    sum += offset;
    sum_of_squares.noalias() += offset * offset.transpose();
}

PlaneMoments& PlaneMoments::operator+=(const PlaneMoments& other) {
    if (other.count == 0) return *this;
    if (count == 0) return *this = other;
    const Eigen::Vector3d shift = other.reference - reference;
    const auto n = static_cast<double>(other.count);
    sum_of_squares += other.sum_of_squares + shift * other.sum.transpose() +
                      other.sum * shift.transpose() + n * shift * shift.transpose();
    sum += other.sum + n * shift;
    count += other.count;
    return *this;
}

std::optional<PlaneFit> PlaneMoments::fit() const {
    if (count < 3) return std::nullopt;
    const auto n = static_cast<double>(count);
    const Eigen::Vector3d mean = sum / n;
    const Eigen::Matrix3d covariance = sum_of_squares / n - mean * mean.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    const Eigen::Vector3d variances = solver.eigenvalues().cwiseMax(0.0);
    // On one line two variances vanish against the third, down to rounding. The direct solver keeps
    // only half the digits of equal eigenvalues; the sum of their products keeps all.
    const double products =
        0.5 * (covariance.trace() * covariance.trace() - covariance.squaredNorm());
    if (!(products > 1e-10 * variances[2] * variances[2])) return std::nullopt;

    PlaneFit result;
    result.centroid = reference + mean;
    result.plane.normal = solver.eigenvectors().col(0).normalized();
    result.plane.offset = result.plane.normal.dot(result.centroid);
    result.rms = std::sqrt(variances[0]);
    result.variances = variances;
    return result;
}

std::optional<PlaneFit> fit_plane(std::span<const Eigen::Vector3f> points) {
    PlaneMoments moments;
    for (const Eigen::Vector3f& point : points)
        moments.add(point.cast<double>());
    return moments.fit();
}

std::optional<PlaneFit> fit_plane(std::span<const Eigen::Vector3f> points,
                                  std::span<const std::uint32_t> indices) {
    PlaneMoments moments;
    for (const std::uint32_t index : indices)
        moments.add(points[index].cast<double>());
    return moments.fit();
}

}  // namespace roomscribe
