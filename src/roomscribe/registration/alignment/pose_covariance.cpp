// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/pose_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/registration/alignment/icp_pairs.hpp"
#include "roomscribe/registration/alignment/residual_field.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The residuals of the pairs, with twists about the centre of the paired points and rotations in
/// units of their extent: all six directions are then in metres and can be compared.
struct Observations {
    std::vector<ResidualRow> rows;
    std::vector<std::size_t> target_rows;            ///< per row: number of its target coordinate
    std::vector<Eigen::Vector3d> source_directions;  ///< per row: what the source says of it
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double extent = 1.0;        ///< m, root mean square distance to the centre
    double weight = 0.0;        ///< of all rows
    double normal_noise = 0.0;  ///< rad, standard deviation of a normal about either axis
    double offset_along = 0.0;  ///< m, root mean square offset along the surface

    Vector6d jacobian(const ResidualRow& row, const Eigen::Vector3d& direction) const {
        Vector6d result;
        result << (row.position - center).cross(direction) / extent, direction;
        return result;
    }
};

void add_rows(Observations& observations, const IcpPair& pair, std::size_t target, double weight,
              IcpMethod method) {
    const auto add = [&](const Eigen::Vector3d& direction, const Eigen::Vector3d& source_direction,
                         std::size_t axis) {
        observations.rows.push_back(
            {pair.moved, direction, direction.dot(pair.offset), weight, Vector6d::Zero()});
        observations.source_directions.push_back(source_direction);
        observations.target_rows.push_back(3 * target + axis);
    };
    if (method != IcpMethod::point_to_point) {
        const bool known = pair.source_normal.allFinite() && !pair.source_normal.isZero();
        add(pair.target_normal, known ? pair.source_normal : pair.target_normal, 0);
        return;
    }
    for (const Eigen::Index axis : {0, 1, 2}) {
        const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
        add(direction, direction, static_cast<std::size_t>(axis));
    }
}

void measure_extent(Observations& observations) {
    for (const ResidualRow& row : observations.rows) {
        observations.center += row.weight * row.position;
        observations.weight += row.weight;
    }
    if (!(observations.weight > 0.0)) return;
    observations.center /= observations.weight;
    double sum = 0.0;
    for (const ResidualRow& row : observations.rows) {
        sum += row.weight * (row.position - observations.center).squaredNorm();
    }
    if (sum > 0.0) observations.extent = std::sqrt(sum / observations.weight);
}

/// Half the difference of the two sides' normals is noise: what is seen of it in the middle of the
/// pairs, where edges do not count.
double measure_normal_noise(const Observations& observations) {
    if (observations.rows.empty()) return 0.0;
    std::vector<double> squares;
    squares.reserve(observations.rows.size());
    for (std::size_t i = 0; i < observations.rows.size(); ++i) {
        squares.push_back(
            (observations.rows[i].direction - observations.source_directions[i]).squaredNorm());
    }
    // Two normals, two axes: 2 variance chi^2_2, whose median is 2 ln 2.
    return std::sqrt(median(squares) / (4.0 * std::log(2.0)));
}

Observations observe(const IcpPairing& pairing, const IcpSource& source, IcpMethod method) {
    Observations observations;
    double squares_along = 0.0;
    for (std::size_t i = 0; i < pairing.num_sources(); ++i) {
        const double weight = pairing.weight(i);
        if (!(weight > 0.0)) continue;
        IcpPair pair = pairing.pair(i);
        if (method == IcpMethod::point_to_plane && !source.normals.empty()) {
            pair.source_normal = pairing.pose().linear() * source.normals[i].cast<double>();
        }
        add_rows(observations, pair, pairing.target_of(i), weight, method);
        squares_along +=
            weight * (pair.offset.squaredNorm() - std::pow(pair.target_normal.dot(pair.offset), 2));
    }
    measure_extent(observations);
    for (ResidualRow& row : observations.rows)
        row.jacobian = observations.jacobian(row, row.direction);
    if (method != IcpMethod::point_to_point && observations.weight > 0.0) {
        observations.normal_noise = measure_normal_noise(observations);
        observations.offset_along = std::sqrt(std::max(0.0, squares_along / observations.weight));
    }
    return observations;
}

/// The directions that the surfaces hold, as columns, and the others.
struct Directions {
    Eigen::Matrix<double, 6, Eigen::Dynamic> held;
    Eigen::Matrix<double, 6, Eigen::Dynamic> free;
};

/// Products of the source's and the target's view of a pair: the noise of their normals, which is
/// independent, has no part in the mean of these, but for its own chance.
Directions split_directions(const Observations& observations) {
    Matrix6d information = Matrix6d::Zero();
    for (std::size_t i = 0; i < observations.rows.size(); ++i) {
        const ResidualRow& row = observations.rows[i];
        const Vector6d other = observations.jacobian(row, observations.source_directions[i]);
        information.noalias() += (0.5 * row.weight * row.jacobian) * other.transpose();
        information.noalias() += (0.5 * row.weight * other) * row.jacobian.transpose();
    }
    // Five standard deviations of that chance; ten neighbours' normals count as one, since they are
    // fitted to the same points. And never less than single-precision normals can tell.
    const double independent = std::max(1.0, 0.1 * static_cast<double>(observations.rows.size()));
    const double chance = 5.0 * std::pow(observations.normal_noise, 2) / std::sqrt(independent);
    const double least = observations.weight * std::max(1e-5, chance);
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
    Eigen::Index num_free = 0;
    while (num_free < 6 && !(solver.eigenvalues()[num_free] > least))
        ++num_free;
    if (observations.rows.size() < 6) num_free = 6;
    return {solver.eigenvectors().rightCols(6 - num_free),
            solver.eigenvectors().leftCols(num_free)};
}

/// The sum over the points of both scans of what the noise of each does to the gradient.
Matrix6d propagated_noise(const Observations& observations, double noise) {
    Matrix6d sum = Matrix6d::Zero();
    // A target point pulls on all source points that it is the nearest of.
    std::map<std::size_t, Vector6d> pulls;
    for (std::size_t i = 0; i < observations.rows.size(); ++i) {
        const ResidualRow& row = observations.rows[i];
        const Vector6d pull = row.weight * row.jacobian;
        sum.noalias() += pull * pull.transpose();
        pulls.try_emplace(observations.target_rows[i], Vector6d::Zero()).first->second += pull;
    }
    for (const auto& [target, pull] : pulls)
        sum.noalias() += pull * pull.transpose();
    return noise * noise * sum;
}

/// What the errors of the observations do to the pose, by way of the inverse information.
Matrix6d gradient_response(const Matrix6d& inverse, const Observations& observations, double noise,
                           const PoseCovarianceSettings& settings) {
    switch (settings.method) {
        case CovarianceMethod::fisher_information:
            return noise * noise * inverse;
        case CovarianceMethod::noise_propagation:
            return inverse * propagated_noise(observations, noise) * inverse;
        case CovarianceMethod::correlated_residuals:
            break;
    }
    const double shared_deviation =
        settings.shared_error * observations.normal_noise * observations.offset_along;
    return inverse * gradient_covariance(observations.rows, observations.extent, shared_deviation) *
           inverse;
}

/// A twist about the centre, with its rotation in units of the extent, as one about the origin.
Matrix6d origin_from_scaled(const Observations& observations) {
    Matrix6d matrix = Matrix6d::Zero();
    const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity() / observations.extent;
    matrix.topLeftCorner<3, 3>() = turn;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        matrix.block<3, 1>(3, axis) = observations.center.cross(turn.col(axis));
    }
    matrix.bottomRightCorner<3, 3>().setIdentity();
    return matrix;
}

}  // namespace

PoseCovariance estimate_pose_covariance(const IcpSource& source, const IcpTarget& target,
                                        const Transform& target_from_source,
                                        const IcpSettings& icp_settings, double noise,
                                        const PoseCovarianceSettings& settings,
                                        const Context& context) {
    check_settings(icp_settings);
    check_settings(settings);
    if (!(noise >= 0.0)) throw InvalidArgument("noise", std::to_string(noise), "at least 0");
    IcpPairing pairing(source, target, icp_settings);
    pairing.update(target_from_source, icp_settings.max_correspondence_distance, context);
    const Observations observations = observe(pairing, source, icp_settings.method);
    const Directions directions = split_directions(observations);

    const bool weighted = settings.method != CovarianceMethod::fisher_information;
    Matrix6d information = Matrix6d::Zero();
    for (const ResidualRow& row : observations.rows) {
        information.noalias() +=
            ((weighted ? row.weight : 1.0) * row.jacobian) * row.jacobian.transpose();
    }
    Matrix6d scaled =
        observations.extent * observations.extent * directions.free * directions.free.transpose();
    if (directions.held.cols() > 0) {
        const Eigen::MatrixXd held_information =
            directions.held.transpose() * information * directions.held;
        const Matrix6d inverse =
            directions.held *
            held_information.ldlt().solve(Eigen::MatrixXd(directions.held.transpose()));
        scaled += gradient_response(inverse, observations, noise, settings);
    }
    const Matrix6d to_origin = origin_from_scaled(observations);
    const Matrix6d covariance = to_origin * scaled * to_origin.transpose();
    PoseCovariance result;
    result.covariance = 0.5 * (covariance + covariance.transpose());
    for (Eigen::Index i = 0; i < directions.free.cols(); ++i) {
        result.unobservable.emplace_back((to_origin * directions.free.col(i)).normalized());
    }
    return result;
}

}  // namespace roomscribe
