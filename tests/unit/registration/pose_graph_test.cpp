// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/pose_graph.hpp"

#include <array>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using test::TransformNear;

Matrix6d information_from(double turn_deviation, double shift_deviation) {
    Vector6d diagonal;
    diagonal.head<3>().setConstant(1.0 / (turn_deviation * turn_deviation));
    diagonal.tail<3>().setConstant(1.0 / (shift_deviation * shift_deviation));
    return diagonal.asDiagonal();
}

Transform shift_by(double x, double y = 0.0, double z = 0.0) {
    Transform shift = Transform::Identity();
    shift.translation() = Vector3d(x, y, z);
    return shift;
}

PoseConstraint measured(const std::vector<Transform>& poses, std::size_t source, std::size_t target,
                        const Matrix6d& information) {
    return {source, target, poses[target].inverse() * poses[source], information};
}

std::vector<Transform> random_poses(Random& random, std::size_t count) {
    std::vector<Transform> poses = {Transform::Identity()};
    while (poses.size() < count)
        poses.push_back(test::random_transform(random, 5.0));
    return poses;
}

TEST(OptimizePoseGraph, AChainComesOutAsItWasMeasured) {
    Random random(1);
    const std::vector<Transform> truth = random_poses(random, 5);
    PoseGraph graph;
    for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
        graph.constraints.push_back(measured(truth, i + 1, i, information_from(0.01, 0.02)));
    }
    graph.map_from_node = truth;
    for (std::size_t i = 1; i < truth.size(); ++i) {
        graph.map_from_node[i] = truth[i] * test::small_transform(random, 0.3, 0.4);
    }
    const PoseGraphResult result = optimize_pose_graph(graph);
    EXPECT_EQ(result.stop, PoseGraphStop::converged);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        EXPECT_THAT(result.map_from_node[i], TransformNear(truth[i], 1e-6, 1e-6));
    }
}

TEST(OptimizePoseGraph, ACovarianceAddsUpAlongAChain) {
    Random random(2);
    const std::vector<Transform> poses = random_poses(random, 4);
    PoseGraph graph{poses, {}, {}};
    Matrix6d expected = Matrix6d::Zero();
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
        const double size = 0.01 * static_cast<double>(i + 1);
        graph.constraints.push_back(measured(poses, i + 1, i, information_from(size, 2.0 * size)));
        const Matrix6d carry = adjoint(poses[i]);
        expected += carry * graph.constraints[i].information.inverse() * carry.transpose();
    }
    const PoseGraphResult result = optimize_pose_graph(graph);
    EXPECT_TRUE(result.covariances[0].isZero());
    EXPECT_LT((result.covariances[3] - expected).norm(), 1e-4 * expected.norm());
}

/// Along a line without turns the poses are those of linear least squares: the closing error is
/// shared out in proportion to the variances.
TEST(OptimizePoseGraph, ALoopSharesItsErrorOutByTheVariances) {
    const std::array<double, 3> deviations = {0.01, 0.02, 0.03};
    constexpr double closing_error = 0.03;
    PoseGraph graph{{shift_by(0), shift_by(1), shift_by(2)}, {}, {}};
    graph.constraints = {
        {1, 0, shift_by(1.0), information_from(1e-5, deviations[0])},
        {2, 1, shift_by(1.0), information_from(1e-5, deviations[1])},
        {2, 0, shift_by(2.0 + closing_error), information_from(1e-5, deviations[2])}};
    const PoseGraphResult result = optimize_pose_graph(graph, {.outlier_distance = 1e6});
    const double total = 0.01 * 0.01 + 0.02 * 0.02 + 0.03 * 0.03;
    const double first = 1.0 + closing_error * 0.01 * 0.01 / total;
    const double second = first + 1.0 + closing_error * 0.02 * 0.02 / total;
    EXPECT_NEAR(result.map_from_node[1].translation().x(), first, 1e-6);
    EXPECT_NEAR(result.map_from_node[2].translation().x(), second, 1e-6);
    const double open = 0.01 * 0.01 + 0.02 * 0.02;
    EXPECT_NEAR(result.covariances[2](3, 3), open * 0.03 * 0.03 / total, 1e-8);
}

/// Small errors: compared with the normal equations of the linearised problem.
TEST(OptimizePoseGraph, AgreesWithLinearLeastSquares) {
    Random random(3);
    const std::vector<Transform> truth = random_poses(random, 4);
    PoseGraph graph{truth, {}, {}};
    const std::array<std::array<std::size_t, 2>, 5> pairs = {
        {{1, 0}, {2, 1}, {3, 2}, {3, 0}, {2, 0}}};
    Eigen::Matrix<double, 18, 18> normal = Eigen::Matrix<double, 18, 18>::Zero();
    Eigen::Matrix<double, 18, 1> right = Eigen::Matrix<double, 18, 1>::Zero();
    for (const auto& [source, target] : pairs) {
        PoseConstraint& link =
            graph.constraints.emplace_back(measured(truth, source, target, Matrix6d::Identity()));
        Matrix6d factor;
        for (Eigen::Index k = 0; k < 36; ++k)
            factor(k) = random.normal();
        link.information = 1e4 * (factor * factor.transpose() + 0.1 * Matrix6d::Identity());
        Vector6d error;
        for (Eigen::Index k = 0; k < 6; ++k)
            error[k] = 1e-5 * random.normal();
        link.target_from_source = transform_from_twist(error) * link.target_from_source;
        // Twists x of the map's frame: the error of the link becomes Ad(T_t^-1)(x_s - x_t) - e.
        Eigen::Matrix<double, 6, 18> jacobian = Eigen::Matrix<double, 6, 18>::Zero();
        const Matrix6d carry = adjoint(truth[target].inverse());
        if (source > 0) jacobian.middleCols<6>(6 * static_cast<Eigen::Index>(source - 1)) += carry;
        if (target > 0) jacobian.middleCols<6>(6 * static_cast<Eigen::Index>(target - 1)) -= carry;
        normal += jacobian.transpose() * link.information * jacobian;
        right += jacobian.transpose() * link.information * error;
    }
    const Eigen::Matrix<double, 18, 1> twists = normal.ldlt().solve(right);
    const Eigen::Matrix<double, 18, 18> covariance = normal.inverse();
    const PoseGraphResult result = optimize_pose_graph(graph, {.outlier_distance = 1e6});
    for (std::size_t node = 1; node < 4; ++node) {
        const auto at = 6 * static_cast<Eigen::Index>(node - 1);
        const Transform expected = transform_from_twist(twists.segment<6>(at)) * truth[node];
        EXPECT_THAT(result.map_from_node[node], TransformNear(expected, 1e-7, 1e-7));
        const Matrix6d block = covariance.block<6, 6>(at, at);
        EXPECT_LT((result.covariances[node] - block).norm(), 1e-3 * block.norm());
    }
}

TEST(OptimizePoseGraph, AWrongLinkDoesNotBendTheMap) {
    Random random(4);
    const std::vector<Transform> truth = random_poses(random, 5);
    PoseGraph graph{truth, {}, {}};
    const Matrix6d information = information_from(0.001, 0.002);
    for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
        graph.constraints.push_back(measured(truth, i + 1, i, information));
    }
    graph.constraints.push_back(measured(truth, 4, 0, information));
    PoseConstraint wrong = measured(truth, 3, 0, information);
    wrong.target_from_source = test::small_transform(random, 3.0, 1.0) * wrong.target_from_source;
    graph.constraints.push_back(wrong);
    const PoseGraphResult result = optimize_pose_graph(graph);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        EXPECT_THAT(result.map_from_node[i], TransformNear(truth[i], 0.002, 0.002));
    }
}

TEST(OptimizePoseGraph, MovesWithAllThatIsGiven) {
    Random random(5);
    const std::vector<Transform> truth = random_poses(random, 5);
    PoseGraph graph{truth, {}, {}};
    for (std::size_t i = 1; i < truth.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            PoseConstraint link = measured(truth, i, j, information_from(0.01, 0.02));
            link.target_from_source =
                test::small_transform(random, 0.01, 0.02) * link.target_from_source;
            graph.constraints.push_back(link);
        }
    }
    PoseGraph moved = graph;
    const Transform motion = test::random_transform(random, 10.0);
    for (Transform& pose : moved.map_from_node)
        pose = motion * pose;
    const PoseGraphResult here = optimize_pose_graph(graph);
    const PoseGraphResult there = optimize_pose_graph(moved);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        EXPECT_THAT(there.map_from_node[i],
                    TransformNear(motion * here.map_from_node[i], 1e-6, 1e-6));
        const Matrix6d carried =
            adjoint(motion) * here.covariances[i] * adjoint(motion).transpose();
        EXPECT_LT((there.covariances[i] - carried).norm(), 1e-3 * carried.norm() + 1e-12);
    }
}

TEST(OptimizePoseGraph, WhatNothingHoldsStaysAndIsKnownToBeUnknown) {
    PoseGraph graph{{shift_by(0), shift_by(2.01)}, {}, {}};
    const Matrix6d covariance = 1e-4 * Matrix6d::Identity();
    const Vector6d along_x = Vector6d::Unit(3);
    graph.constraints = {{1, 0, shift_by(2.0, 0.5), information_of(covariance, {&along_x, 1})}};
    const PoseGraphResult result = optimize_pose_graph(graph);
    EXPECT_NEAR(result.map_from_node[1].translation().x(), 2.01, 1e-9);
    EXPECT_NEAR(result.map_from_node[1].translation().y(), 0.5, 1e-6);
    EXPECT_NEAR(result.covariances[1](3, 3), 1e6, 1e2);
    EXPECT_NEAR(result.covariances[1](4, 4), 1e-4, 1e-7);
}

TEST(OptimizePoseGraph, SetsThatNothingJoinsKeepTheirFirstAndFixedNodesStay) {
    PoseGraph graph{{shift_by(0), shift_by(1.1), shift_by(5), shift_by(6.1)}, {}, {}};
    const Matrix6d information = information_from(0.01, 0.01);
    graph.constraints = {{1, 0, shift_by(1.0), information}, {3, 2, shift_by(1.0), information}};
    const auto x_of = [](const PoseGraphResult& result, std::size_t node) {
        return result.map_from_node[node].translation().x();
    };
    PoseGraphResult result = optimize_pose_graph(graph);
    EXPECT_EQ(x_of(result, 2), 5.0);
    EXPECT_NEAR(x_of(result, 1), 1.0, 1e-6);
    EXPECT_NEAR(x_of(result, 3), 6.0, 1e-6);
    graph.fixed = {3};
    result = optimize_pose_graph(graph);
    EXPECT_NEAR(x_of(result, 2), 5.1, 1e-6);
    EXPECT_EQ(x_of(result, 3), 6.1);
}

TEST(OptimizePoseGraph, RefusesNodesThatAreNotThere) {
    EXPECT_THROW(optimize_pose_graph({{shift_by(0)}, {{1, 0, shift_by(1)}}, {}}), InvalidArgument);
    EXPECT_THROW(optimize_pose_graph({{shift_by(0)}, {{0, 0, shift_by(1)}}, {}}), InvalidArgument);
    EXPECT_THROW(optimize_pose_graph({{shift_by(0)}, {}, {1}}), InvalidArgument);
}

TEST(InformationOf, IsTheLimitOfGreatUncertainty) {
    Random random(6);
    Matrix6d factor;
    for (Eigen::Index k = 0; k < 36; ++k)
        factor(k) = random.normal();
    const Matrix6d covariance = factor * factor.transpose() + 0.1 * Matrix6d::Identity();
    const std::vector<Vector6d> free = {Vector6d::Unit(2), Vector6d(0.1 * Vector6d::Ones())};
    Matrix6d vast = covariance;
    for (const Vector6d& direction : free)
        vast += 1e9 * direction * direction.transpose();
    EXPECT_LT((information_of(covariance, free) - vast.inverse()).norm(), 1e-5);
    EXPECT_LT((information_of(covariance, free) * free[1]).norm(), 1e-9);
    EXPECT_LT((information_of(covariance, {}) * covariance - Matrix6d::Identity()).norm(), 1e-9);
}

TEST(TwistBetween, UndoesTransformFromTwist) {
    Random random(7);
    const Transform b = test::random_transform(random);
    Vector6d twist;
    twist << 0.3, -0.2, 0.1, 1.0, 2.0, 3.0;
    EXPECT_LT((twist_between(transform_from_twist(twist) * b, b) - twist).norm(), 1e-12);
    EXPECT_LT(twist_between(b, b).norm(), 1e-12);
}

TEST(Adjoint, CarriesATwistThroughAMotion) {
    Random random(8);
    const Transform motion = test::random_transform(random);
    Vector6d twist;
    twist << 3e-6, -2e-6, 1e-6, 1e-6, 2e-6, 3e-6;
    const Transform carried = motion * transform_from_twist(twist);
    EXPECT_LT((twist_between(carried, motion) - adjoint(motion) * twist).norm(), 1e-10);
}

}  // namespace
}  // namespace roomscribe
