// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/icp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/registration/alignment/icp_pairs.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// What one pass over the pairs gathers, for any method.
struct PairSums {
    std::size_t num_pairs = 0;
    double weight = 0.0;
    double squared_error = 0.0;
    // Gauss-Newton normal equations of a small motion in the target frame.
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    // Closed form of point-to-point: sums and products of the moved and the target points.
    Eigen::Vector3d moved_sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d target_sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d moved_products = Eigen::Matrix3d::Zero();

    PairSums& operator+=(const PairSums& other) {
        num_pairs += other.num_pairs;
        weight += other.weight;
        squared_error += other.squared_error;
        information += other.information;
        gradient += other.gradient;
        moved_sum += other.moved_sum;
        target_sum += other.target_sum;
        products += other.products;
        moved_products += other.moved_products;
        return *this;
    }
    double rmse() const { return weight > 0.0 ? std::sqrt(squared_error / weight) : 0.0; }
};

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
    Eigen::Matrix3d matrix;
    matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return matrix;
}

void add_point_pair(PairSums& sums, const IcpPair& pair, double weight) {
    const Eigen::Vector3d target = pair.moved - pair.offset;
    sums.moved_sum += weight * pair.moved;
    sums.target_sum += weight * target;
    sums.products.noalias() += (weight * target) * pair.moved.transpose();
    sums.moved_products.noalias() += (weight * pair.moved) * pair.moved.transpose();
}

void add_plane_pair(PairSums& sums, const IcpPair& pair, double weight) {
    Vector6d jacobian;
    jacobian << pair.moved.cross(pair.target_normal), pair.target_normal;
    sums.information.noalias() += (weight * jacobian) * jacobian.transpose();
    sums.gradient += (weight * pair.target_normal.dot(pair.offset)) * jacobian;
}

void add_generalized_pair(PairSums& sums, const IcpPair& pair, double weight) {
    const Eigen::Matrix3d metric = weight * pair.generalized_metric();
    const Eigen::Matrix3d turned = skew(pair.moved) * metric;
    sums.information.topLeftCorner<3, 3>().noalias() -= turned * skew(pair.moved);
    sums.information.topRightCorner<3, 3>() += turned;
    sums.information.bottomLeftCorner<3, 3>() += turned.transpose();
    sums.information.bottomRightCorner<3, 3>() += metric;
    const Eigen::Vector3d force = metric * pair.offset;
    sums.gradient.head<3>() += pair.moved.cross(force);
    sums.gradient.tail<3>() += force;
}

/// Sum of the squared Jacobians [-skew(moved) I] of point-to-point: the matrix of the paper's
/// equation (2), without the sensor noise.
Matrix6d point_information(const PairSums& sums) {
    Matrix6d information;
    information.topLeftCorner<3, 3>() =
        sums.moved_products.trace() * Eigen::Matrix3d::Identity() - sums.moved_products;
    information.topRightCorner<3, 3>() = skew(sums.moved_sum);
    information.bottomLeftCorner<3, 3>() = -skew(sums.moved_sum);
    information.bottomRightCorner<3, 3>() = sums.weight * Eigen::Matrix3d::Identity();
    return information;
}

PairSums sum_pairs(const IcpPairing& pairing, IcpMethod method, const Context& context) {
    const auto sum_range = [&](std::size_t begin, std::size_t end) {
        PairSums sums;
        for (std::size_t i = begin; i < end; ++i) {
            const double weight = pairing.weight(i);
            if (!(weight > 0.0)) continue;
            const double residual = pairing.residual(i);
            ++sums.num_pairs;
            sums.weight += weight;
            sums.squared_error += weight * residual * residual;
            switch (method) {
                case IcpMethod::point_to_point:
                    add_point_pair(sums, pairing.pair(i), weight);
                    break;
                case IcpMethod::point_to_plane:
                    add_plane_pair(sums, pairing.pair(i), weight);
                    break;
                case IcpMethod::generalized:
                    add_generalized_pair(sums, pairing.pair(i), weight);
                    break;
            }
        }
        return sums;
    };
    PairSums sums =
        parallel_reduce(context, pairing.num_sources(), 2048, PairSums{}, sum_range,
                        [](PairSums total, const PairSums& part) { return total += part; });
    if (method == IcpMethod::point_to_point) sums.information = point_information(sums);
    return sums;
}

/// Step 6 for equation (1): the motion in closed form (Kabsch).
Transform step_point_to_point(const PairSums& sums) {
    const Eigen::Vector3d moved_mean = sums.moved_sum / sums.weight;
    const Eigen::Vector3d target_mean = sums.target_sum / sums.weight;
    Transform step = Transform::Identity();
    step.linear() =
        nearest_rotation(sums.products - sums.weight * target_mean * moved_mean.transpose());
    step.translation() = target_mean - step.linear() * moved_mean;
    return step;
}

/// Step 6 for the other methods: one Gauss-Newton step. Directions that no plane holds are left
/// alone (the smallest eigenvalues against the largest), so that a corridor does not run away.
Transform step_gauss_newton(const PairSums& sums) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(sums.information);
    const double smallest_kept = 1e-9 * solver.eigenvalues()[5];
    Vector6d twist = Vector6d::Zero();
    for (Eigen::Index i = 0; i < 6; ++i) {
        const double eigenvalue = solver.eigenvalues()[i];
        if (!(eigenvalue > smallest_kept)) continue;
        const Vector6d direction = solver.eigenvectors().col(i);
        twist -= direction * (direction.dot(sums.gradient) / eigenvalue);
    }
    return transform_from_twist(twist);
}

/// How far a step moves the farthest corner of the points.
double displacement(const Transform& step, double radius) {
    return step.translation().norm() + radius * rotation_angle(step.linear());
}

}  // namespace

std::string_view icp_stop_name(IcpStop stop) {
    switch (stop) {
        case IcpStop::converged:
            return "converged";
        case IcpStop::max_iterations:
            return "max_iterations";
        case IcpStop::too_few_pairs:
            return "too_few_pairs";
    }
    return "";
}

IcpResult align_icp(const IcpSource& source, const IcpTarget& target,
                    const Transform& target_from_source_guess, const IcpSettings& settings,
                    const Context& context) {
    check_settings(settings);
    IcpPairing pairing(source, target, settings);
    IcpResult result;
    result.target_from_source = target_from_source_guess;
    result.reach = settings.max_correspondence_distance;
    if (source.positions.empty() || target.tree.size() == 0) return result;
    float radius = 0.0F;
    for (const Eigen::Vector3f& point : target.positions)
        radius = std::max(radius, point.norm());

    constexpr std::size_t min_pairs = 6;
    double previous_error = std::numeric_limits<double>::infinity();
    double last_move = std::numeric_limits<double>::infinity();
    bool reach_is_settled = settings.reach_shrink == 1.0;
    result.stop = IcpStop::max_iterations;
    for (int iteration = 0;; ++iteration) {
        pairing.update(result.target_from_source, result.reach, context);
        const PairSums sums = sum_pairs(pairing, settings.method, context);
        result.num_pairs = sums.num_pairs;
        result.rmse = sums.rmse();
        result.scale = pairing.scale();
        result.information = sums.information;
        result.errors.push_back(result.rmse);
        if (sums.num_pairs < min_pairs) {
            result.stop = IcpStop::too_few_pairs;
            break;
        }
        if (reach_is_settled &&
            std::abs(previous_error - result.rmse) < settings.min_error_change &&
            last_move < 10.0 * settings.min_error_change) {
            result.stop = IcpStop::converged;
            break;
        }
        if (iteration == settings.max_iterations) break;
        const Transform step = settings.method == IcpMethod::point_to_point
                                   ? step_point_to_point(sums)
                                   : step_gauss_newton(sums);
        result.target_from_source = step * result.target_from_source;
        previous_error = result.rmse;
        last_move = displacement(step, static_cast<double>(radius));
        if (!reach_is_settled) {
            const double reach =
                std::max(settings.reach_shrink * result.reach, 3.0 * pairing.distance_scale());
            reach_is_settled = reach >= result.reach;
            result.reach = std::min(reach, result.reach);
        }
    }
    result.target_from_source.linear() = nearest_rotation(result.target_from_source.linear());
    return result;
}

}  // namespace roomscribe
