// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

namespace roomscribe {

/// One scalar residual of an alignment.
struct ResidualRow {
    Eigen::Vector3d position;   ///< where it was measured
    Eigen::Vector3d direction;  ///< unit: what was measured is the offset along it
    double residual;            ///< m
    double weight;
    Eigen::Matrix<double, 6, 1> jacobian;  ///< of the residual with respect to the pose
};

/// Covariance of the cost's gradient, sum of weight * residual * jacobian, over errors like those
/// that the residuals show: independent ones, and a field of displacements whose correlation falls
/// exponentially with distance (an exponential variogram, Cressie 1993, fitted to the means of
/// patches), so that residuals along directions a and b correlate by a.b times that. On top, a
/// field of `shared_error` times the residuals' standard deviation that varies over `extent` (m,
/// the size of the whole): the part of the error that the fit itself has taken up. Does not depend
/// on the frame; zero without rows.
Eigen::Matrix<double, 6, 6> gradient_covariance(std::span<const ResidualRow> rows, double extent,
                                                double shared_deviation);

}  // namespace roomscribe
