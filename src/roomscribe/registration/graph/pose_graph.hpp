// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// A measured relative pose of two nodes of a pose graph.
struct PoseConstraint {
    std::size_t source = 0;
    std::size_t target = 0;
    Transform target_from_source = Transform::Identity();
    /// Inverse covariance of target_from_source, whose error is a twist (rotation vector about the
    /// target's origin, translation) in the target's frame; singular where nothing is known.
    Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Identity();
};

struct PoseGraph {
    std::vector<Transform> map_from_node;  ///< where the search starts
    std::vector<PoseConstraint> constraints;
    /// Nodes that stay where they are. Where the constraints join none of them, the first of a
    /// connected set of nodes stays.
    std::vector<std::size_t> fixed;
};

struct PoseGraphSettings {
    double outlier_distance = 4.0;
    int max_iterations = 100;

    void visit(SettingVisitor& visitor) {
        visitor(outlier_distance,
                {.name = "outlier_distance",
                 .unit = "",
                 .min = 1e-3,
                 .max = 1e12,
                 .doc = "A link that is off by more standard deviations loses its influence."});
        visitor(max_iterations, {.name = "max_iterations",
                                 .unit = "",
                                 .min = 1,
                                 .max = 100'000,
                                 .doc = "Most iterations of the optimisation."});
    }
};

enum class PoseGraphStop : std::uint8_t { converged, max_iterations };

struct PoseGraphResult {
    std::vector<Transform> map_from_node;
    /// Of map_from_node, as errors of constraints are: zero for a node that stays. Directions that
    /// no constraint holds keep the variance of knowing nothing (1e6, in rad2 or m2).
    std::vector<Eigen::Matrix<double, 6, 6>> covariances;
    PoseGraphStop stop = PoseGraphStop::converged;
};

/// Poses that agree best with all constraints: least squares on SE(3), first with a Huber, then
/// with a Cauchy loss, so that errors are shared out and yet a wrong constraint cannot bend the map
/// (its influence goes to zero with its error). What nothing holds stays where it was. Same bits on
/// any number of threads. Throws InvalidArgument for a node number out of range.
PoseGraphResult optimize_pose_graph(const PoseGraph& graph, const PoseGraphSettings& settings = {},
                                    const Context& context = {});

/// The inverse of a covariance, with nothing known along the free directions (twists).
/// Precondition: the covariance is positive definite.
Eigen::Matrix<double, 6, 6> information_of(
    const Eigen::Matrix<double, 6, 6>& covariance,
    std::span<const Eigen::Matrix<double, 6, 1>> free_directions);

/// How an error twist of the source end looks in the frame that `target_from_source` leads to.
Eigen::Matrix<double, 6, 6> adjoint(const Transform& target_from_source);

/// The small twist `t` with a = transform_from_twist(t) * b.
Eigen::Matrix<double, 6, 1> twist_between(const Transform& a, const Transform& b);

}  // namespace roomscribe
