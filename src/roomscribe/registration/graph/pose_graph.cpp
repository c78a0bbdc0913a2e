// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/pose_graph.hpp"

#include <array>
#include <memory>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <fmt/format.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The standard deviation of knowing nothing, in rad or m: no indoor pose is off by more.
constexpr double vague_deviation = 1e3;

/// A pose as the solver moves it.
struct PoseBlock {
    Eigen::Quaterniond rotation;
    Eigen::Vector3d translation;
};

template <typename Scalar>
using Twist = Eigen::Matrix<Scalar, 6, 1>;

/// The twist of a rotation and a translation. Near the identity its derivatives are finite.
template <typename Scalar>
Twist<Scalar> twist_of(const Eigen::Quaternion<Scalar>& rotation,
                       const Eigen::Matrix<Scalar, 3, 1>& translation) {
    const std::array<Scalar, 4> quaternion = {rotation.w(), rotation.x(), rotation.y(),
                                              rotation.z()};
    Twist<Scalar> twist;
    ceres::QuaternionToAngleAxis(quaternion.data(), twist.data());
    twist.template tail<3>() = translation;
    return twist;
}

/// The error of a relative pose, in standard deviations.
class RelativePoseError {
  public:
    RelativePoseError(const Transform& target_from_source, const Matrix6d& information)
        : source_from_target_rotation_(target_from_source.linear().transpose()),
          source_from_target_translation_(target_from_source.inverse().translation()) {
        const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
        square_root_ = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                       solver.eigenvectors().transpose();
    }

    template <typename Scalar>
    bool operator()(const Scalar* source_rotation, const Scalar* source_translation,
                    const Scalar* target_rotation, const Scalar* target_translation,
                    Scalar* residuals) const {
        using Rotation = Eigen::Quaternion<Scalar>;
        using Vector = Eigen::Matrix<Scalar, 3, 1>;
        const Eigen::Map<const Rotation> source_turn(source_rotation);
        const Eigen::Map<const Rotation> target_turn(target_rotation);
        const Eigen::Map<const Vector> source_place(source_translation);
        const Eigen::Map<const Vector> target_place(target_translation);

        const Rotation from_map = target_turn.conjugate();
        const Rotation relative = from_map * source_turn;
        const Rotation error = relative * source_from_target_rotation_.cast<Scalar>();
        const Vector shift = relative * Vector(source_from_target_translation_.cast<Scalar>()) +
                             from_map * Vector(source_place - target_place);
        Eigen::Map<Twist<Scalar>> result(residuals);
        result = square_root_.cast<Scalar>() * twist_of<Scalar>(error, shift);
        return true;
    }

  private:
    Eigen::Quaterniond source_from_target_rotation_;
    Eigen::Vector3d source_from_target_translation_;
    Matrix6d square_root_;
};

/// Holds a pose where nothing else does, so weakly that it yields to anything.
class VagueKnowledge {
  public:
    explicit VagueKnowledge(const PoseBlock& start) : start_(start) {}

    template <typename Scalar>
    bool operator()(const Scalar* rotation, const Scalar* translation, Scalar* residuals) const {
        using Vector = Eigen::Matrix<Scalar, 3, 1>;
        const Eigen::Map<const Eigen::Quaternion<Scalar>> turn(rotation);
        const Eigen::Map<const Vector> place(translation);
        const Eigen::Quaternion<Scalar> error = turn * start_.rotation.conjugate().cast<Scalar>();
        Eigen::Map<Twist<Scalar>> result(residuals);
        result = twist_of<Scalar>(error, place - start_.translation.cast<Scalar>()) /
                 Scalar(vague_deviation);
        return true;
    }

  private:
    PoseBlock start_;
};

/// Which nodes must not move: those that are fixed, and the first of each set without such a one.
std::vector<bool> find_anchors(const PoseGraph& graph) {
    const std::size_t num_nodes = graph.map_from_node.size();
    std::vector<std::size_t> group(num_nodes);
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto group_of = [&group](std::size_t node) {
        while (group[node] != node)
            node = group[node];
        return node;
    };
    for (const PoseConstraint& constraint : graph.constraints) {
        const std::size_t a = group_of(constraint.source);
        const std::size_t b = group_of(constraint.target);
        group[std::max(a, b)] = std::min(a, b);
    }
    std::vector<bool> is_anchor(num_nodes, false);
    std::vector<bool> has_anchor(num_nodes, false);
    for (const std::size_t node : graph.fixed) {
        is_anchor[node] = true;
        has_anchor[group_of(node)] = true;
    }
    for (std::size_t node = 0; node < num_nodes; ++node) {
        if (group_of(node) == node && !has_anchor[node]) is_anchor[node] = true;
    }
    return is_anchor;
}

void check_nodes(const PoseGraph& graph) {
    const std::size_t num_nodes = graph.map_from_node.size();
    const auto check = [num_nodes](std::size_t node) {
        if (node >= num_nodes) {
            throw InvalidArgument("graph", fmt::format("node {}", node),
                                  fmt::format("nodes below {}", num_nodes));
        }
    };
    for (const PoseConstraint& constraint : graph.constraints) {
        check(constraint.source);
        check(constraint.target);
        if (constraint.source == constraint.target) {
            throw InvalidArgument("graph", fmt::format("a link of {} to itself", constraint.source),
                                  "links of different nodes");
        }
    }
    for (const std::size_t node : graph.fixed)
        check(node);
}

/// The graph as a problem of the solver, whose poses it keeps.
class GraphProblem {
  public:
    explicit GraphProblem(const PoseGraph& graph)
        : graph_(graph), is_anchor_(find_anchors(graph)), problem_(problem_options()) {
        blocks_.reserve(graph.map_from_node.size());
        for (const Transform& pose : graph.map_from_node) {
            PoseBlock& block = blocks_.emplace_back();
            block.rotation = Eigen::Quaterniond(pose.linear()).normalized();
            block.translation = pose.translation();
            add_block(block, is_anchor_[blocks_.size() - 1]);
        }
        for (const PoseConstraint& constraint : graph.constraints)
            add_constraint(constraint);
    }

    PoseGraphStop solve(std::unique_ptr<ceres::LossFunction> loss, int max_iterations) {
        loss_.Reset(loss.release(), ceres::TAKE_OWNERSHIP);
        ceres::Solver::Options options;
        // One thread and Eigen's own factorisation: the same bits everywhere.
        options.num_threads = 1;
        options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
        options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
        options.logging_type = ceres::SILENT;
        options.max_num_iterations = max_iterations;
        options.function_tolerance = 1e-12;
        options.parameter_tolerance = 1e-12;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem_, &summary);
        return summary.termination_type == ceres::CONVERGENCE ? PoseGraphStop::converged
                                                              : PoseGraphStop::max_iterations;
    }

    std::vector<Transform> poses() const {
        std::vector<Transform> poses;
        poses.reserve(blocks_.size());
        for (std::size_t node = 0; node < blocks_.size(); ++node) {
            Transform& pose = poses.emplace_back(graph_.map_from_node[node]);
            if (is_anchor_[node]) continue;
            pose.linear() = blocks_[node].rotation.normalized().toRotationMatrix();
            pose.translation() = blocks_[node].translation;
        }
        return poses;
    }

    std::vector<Matrix6d> covariances() {
        std::vector<Matrix6d> covariances(blocks_.size(), Matrix6d::Zero());
        std::vector<std::pair<const double*, const double*>> wanted;
        for (std::size_t node = 0; node < blocks_.size(); ++node) {
            if (is_anchor_[node]) continue;
            const double* rotation = blocks_[node].rotation.coeffs().data();
            const double* translation = blocks_[node].translation.data();
            wanted.emplace_back(rotation, rotation);
            wanted.emplace_back(rotation, translation);
            wanted.emplace_back(translation, translation);
        }
        if (wanted.empty()) return covariances;
        ceres::Covariance::Options options;
        options.num_threads = 1;
        options.algorithm_type = ceres::SPARSE_QR;
        options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
        options.min_reciprocal_condition_number = 1e-20;
        ceres::Covariance covariance(options);
        // The vague knowledge makes every direction known, if only just.
        if (!covariance.Compute(wanted, &problem_)) return covariances;
        for (std::size_t node = 0; node < blocks_.size(); ++node) {
            if (!is_anchor_[node]) covariances[node] = block_covariance(covariance, blocks_[node]);
        }
        return covariances;
    }

  private:
    static ceres::Problem::Options problem_options() {
        ceres::Problem::Options options;
        options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        return options;
    }

    void add_block(PoseBlock& block, bool is_anchor) {
        double* const rotation = block.rotation.coeffs().data();
        double* const translation = block.translation.data();
        problem_.AddParameterBlock(rotation, 4, &turns_);
        problem_.AddParameterBlock(translation, 3);
        if (is_anchor) {
            problem_.SetParameterBlockConstant(rotation);
            problem_.SetParameterBlockConstant(translation);
            return;
        }
        auto error = std::make_unique<VagueKnowledge>(block);
        auto cost =
            std::make_unique<ceres::AutoDiffCostFunction<VagueKnowledge, 6, 4, 3>>(error.release());
        problem_.AddResidualBlock(cost.release(), nullptr, rotation, translation);
    }

    void add_constraint(const PoseConstraint& constraint) {
        PoseBlock& source = blocks_[constraint.source];
        PoseBlock& target = blocks_[constraint.target];
        auto error = std::make_unique<RelativePoseError>(constraint.target_from_source,
                                                         constraint.information);
        auto cost = std::make_unique<ceres::AutoDiffCostFunction<RelativePoseError, 6, 4, 3, 4, 3>>(
            error.release());
        problem_.AddResidualBlock(cost.release(), &loss_, source.rotation.coeffs().data(),
                                  source.translation.data(), target.rotation.coeffs().data(),
                                  target.translation.data());
    }

    static Matrix6d block_covariance(const ceres::Covariance& covariance, const PoseBlock& block) {
        using Matrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
        const double* rotation = block.rotation.coeffs().data();
        const double* translation = block.translation.data();
        Matrix3d turn;
        Matrix3d turn_and_shift;
        Matrix3d shift;
        covariance.GetCovarianceBlockInTangentSpace(rotation, rotation, turn.data());
        covariance.GetCovarianceBlockInTangentSpace(rotation, translation, turn_and_shift.data());
        covariance.GetCovarianceBlockInTangentSpace(translation, translation, shift.data());
        // The tangent of the solver's quaternions is half a rotation vector, and its translation is
        // that of the node's origin; a twist turns about the map's.
        Matrix6d joint;
        joint << 4.0 * turn, 2.0 * turn_and_shift, 2.0 * turn_and_shift.transpose(), shift;
        const Eigen::Vector3d& t = block.translation;
        Matrix6d twist_from_tangent = Matrix6d::Identity();
        twist_from_tangent.bottomLeftCorner<3, 3>() << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(),
            -t.y(), t.x(), 0.0;
        return twist_from_tangent * joint * twist_from_tangent.transpose();
    }

    const PoseGraph& graph_;
    std::vector<bool> is_anchor_;
    std::vector<PoseBlock> blocks_;
    ceres::EigenQuaternionManifold turns_;
    ceres::LossFunctionWrapper loss_{nullptr, ceres::TAKE_OWNERSHIP};
    ceres::Problem problem_;
};

}  // namespace

PoseGraphResult optimize_pose_graph(const PoseGraph& graph, const PoseGraphSettings& settings,
                                    const Context& context) {
    check_settings(settings);
    check_nodes(graph);
    context.throw_if_cancelled();
    GraphProblem problem(graph);
    PoseGraphResult result;
    // The Huber loss has one minimum: it shares a loop's error out, however large. From there the
    // Cauchy loss lets go of what is still far off.
    problem.solve(std::make_unique<ceres::HuberLoss>(settings.outlier_distance),
                  settings.max_iterations);
    result.stop = problem.solve(std::make_unique<ceres::CauchyLoss>(settings.outlier_distance),
                                settings.max_iterations);
    result.map_from_node = problem.poses();
    result.covariances = problem.covariances();
    return result;
}

Eigen::Matrix<double, 6, 6> information_of(
    const Eigen::Matrix<double, 6, 6>& covariance,
    std::span<const Eigen::Matrix<double, 6, 1>> free_directions) {
    const Matrix6d inverse = covariance.ldlt().solve(Matrix6d::Identity());
    Matrix6d information = 0.5 * (inverse + inverse.transpose());
    if (free_directions.empty()) return information;
    // The limit of (C + s U U^T)^-1 for s to infinity: uncertain without end along U.
    Eigen::Matrix<double, 6, Eigen::Dynamic> free(6, free_directions.size());
    for (std::size_t i = 0; i < free_directions.size(); ++i) {
        free.col(static_cast<Eigen::Index>(i)) = free_directions[i];
    }
    const Eigen::MatrixXd held = information * free;
    const Eigen::MatrixXd inner = free.transpose() * held;
    return information - held * inner.completeOrthogonalDecomposition().solve(held.transpose());
}

Eigen::Matrix<double, 6, 6> adjoint(const Transform& target_from_source) {
    const Eigen::Matrix3d& rotation = target_from_source.linear();
    const Eigen::Vector3d t = target_from_source.translation();
    Eigen::Matrix3d cross;
    cross << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
    Matrix6d result = Matrix6d::Zero();
    result.topLeftCorner<3, 3>() = rotation;
    result.bottomRightCorner<3, 3>() = rotation;
    result.bottomLeftCorner<3, 3>() = cross * rotation;
    return result;
}

Eigen::Matrix<double, 6, 1> twist_between(const Transform& a, const Transform& b) {
    const Transform difference = a * b.inverse();
    return twist_of<double>(Eigen::Quaterniond(difference.linear()),
                            Eigen::Vector3d(difference.translation()));
}

}  // namespace roomscribe
