// SPDX-License-Identifier: MIT
#include "roomscribe/registration/icp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// What one pass over the source gathers, for either method.
struct PairSums {
    std::size_t num_pairs = 0;
    double squared_error = 0.0;
    // Gauss-Newton normal equations of a small motion in the target frame.
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    // Closed form of point-to-point: sums and products of the moved and the target points.
    Eigen::Vector3d moved_sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d target_sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

    PairSums& operator+=(const PairSums& other) {
        num_pairs += other.num_pairs;
        squared_error += other.squared_error;
        information += other.information;
        gradient += other.gradient;
        moved_sum += other.moved_sum;
        target_sum += other.target_sum;
        products += other.products;
        return *this;
    }
    double rmse() const {
        return num_pairs == 0 ? 0.0 : std::sqrt(squared_error / static_cast<double>(num_pairs));
    }
};

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
    Eigen::Matrix3d matrix;
    matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return matrix;
}

void add_point_pair(PairSums& sums, const Eigen::Vector3d& moved, const Eigen::Vector3d& target) {
    const Eigen::Vector3d residual = moved - target;
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << -skew(moved), Eigen::Matrix3d::Identity();
    ++sums.num_pairs;
    sums.squared_error += residual.squaredNorm();
    sums.information.noalias() += jacobian.transpose() * jacobian;
    sums.moved_sum += moved;
    sums.target_sum += target;
    sums.products.noalias() += target * moved.transpose();
}

void add_plane_pair(PairSums& sums, const Eigen::Vector3d& moved, const Eigen::Vector3d& target,
                    const Eigen::Vector3d& normal) {
    const double residual = normal.dot(moved - target);
    Vector6d jacobian;
    jacobian << moved.cross(normal), normal;
    ++sums.num_pairs;
    sums.squared_error += residual * residual;
    sums.information.noalias() += jacobian * jacobian.transpose();
    sums.gradient += residual * jacobian;
}

/// Step 5 of Algorithm 1: the closest points under the present motion, and their sums.
PairSums gather_pairs(const IcpSource& source, const IcpTarget& target,
                      const Transform& target_from_source, const IcpSettings& settings,
                      const Context& context) {
    const bool with_normals = !source.normals.empty() && !target.normals.empty();
    const double max_squared_distance =
        settings.max_correspondence_distance * settings.max_correspondence_distance;
    const double min_cosine = std::cos(std::min(settings.max_normal_angle, 3.1415));
    const auto gather = [&](std::size_t begin, std::size_t end) {
        PairSums sums;
        for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector3d moved = target_from_source * source.positions[i].cast<double>();
            const Neighbor neighbor = target.tree.nearest(moved.cast<float>());
            if (neighbor.squared_distance > max_squared_distance) continue;
            if (with_normals) {
                const Eigen::Vector3d turned =
                    target_from_source.linear() * source.normals[i].cast<double>();
                // Negated so that a NaN normal takes no part.
                if (!(turned.dot(target.normals[neighbor.index].cast<double>()) >= min_cosine)) {
                    continue;
                }
            }
            const Eigen::Vector3d closest = target.positions[neighbor.index].cast<double>();
            if (settings.method == IcpMethod::point_to_point) {
                add_point_pair(sums, moved, closest);
            } else if (target.normals[neighbor.index].allFinite()) {
                add_plane_pair(sums, moved, closest, target.normals[neighbor.index].cast<double>());
            }
        }
        return sums;
    };
    return parallel_reduce(context, source.positions.size(), 2048, PairSums{}, gather,
                           [](PairSums total, const PairSums& part) { return total += part; });
}

/// Step 6 for equation (1): the motion in closed form (Kabsch).
Transform step_point_to_point(const PairSums& sums) {
    const auto count = static_cast<double>(sums.num_pairs);
    const Eigen::Vector3d moved_mean = sums.moved_sum / count;
    const Eigen::Vector3d target_mean = sums.target_sum / count;
    Transform step = Transform::Identity();
    step.linear() = nearest_rotation(sums.products - count * target_mean * moved_mean.transpose());
    step.translation() = target_mean - step.linear() * moved_mean;
    return step;
}

/// Step 6 for point-to-plane: one Gauss-Newton step. Directions that no plane holds are left alone
/// (the smallest eigenvalues against the largest), so that a corridor does not run away.
Transform step_point_to_plane(const PairSums& sums) {
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
    if (settings.method == IcpMethod::point_to_plane && target.normals.empty()) {
        throw InvalidArgument("method", "point_to_plane", "used with target normals");
    }
    IcpResult result;
    result.target_from_source = target_from_source_guess;
    if (source.positions.empty() || target.tree.size() == 0) return result;
    float radius = 0.0F;
    for (const Eigen::Vector3f& point : target.positions)
        radius = std::max(radius, point.norm());

    constexpr std::size_t min_pairs = 6;
    double previous_error = std::numeric_limits<double>::infinity();
    double last_move = std::numeric_limits<double>::infinity();
    result.stop = IcpStop::max_iterations;
    for (int iteration = 0;; ++iteration) {
        const PairSums sums =
            gather_pairs(source, target, result.target_from_source, settings, context);
        result.num_pairs = sums.num_pairs;
        result.rmse = sums.rmse();
        result.information = sums.information;
        result.errors.push_back(result.rmse);
        if (sums.num_pairs < min_pairs) {
            result.stop = IcpStop::too_few_pairs;
            break;
        }
        if (std::abs(previous_error - result.rmse) < settings.min_error_change &&
            last_move < 10.0 * settings.min_error_change) {
            result.stop = IcpStop::converged;
            break;
        }
        if (iteration == settings.max_iterations) break;
        const Transform step = settings.method == IcpMethod::point_to_point
                                   ? step_point_to_point(sums)
                                   : step_point_to_plane(sums);
        result.target_from_source = step * result.target_from_source;
        previous_error = result.rmse;
        last_move = displacement(step, static_cast<double>(radius));
    }
    result.target_from_source.linear() = nearest_rotation(result.target_from_source.linear());
    return result;
}

}  // namespace roomscribe
