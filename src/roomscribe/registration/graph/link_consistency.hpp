// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/registration_result.hpp"

namespace roomscribe {

/// What every link may be off by beside its own covariance, one standard deviation: links are
/// judged by whether they are right, not by how well the scanner is calibrated.
struct LinkTolerance {
    double rotation = 0.005;    ///< rad
    double translation = 0.02;  ///< m
};

/// A relative pose that a chain of links leads to.
struct ChainedPose {
    Transform target_from_source = Transform::Identity();
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    std::vector<Eigen::Matrix<double, 6, 1>> unobservable;
};

/// What a link says, with the tolerance in its covariance.
ChainedPose chain_of(const RegistrationLink& link, const LinkTolerance& tolerance);
/// The way back.
ChainedPose reversed(const ChainedPose& pose);
/// First from the source of `inner`, then on to the target of `outer`.
ChainedPose operator*(const ChainedPose& outer, const ChainedPose& inner);

/// The same link the other way round.
RegistrationLink reversed(const RegistrationLink& link);

/// Whether two statements on one relative pose can both be true: their squared Mahalanobis distance
/// stays below the 0.999 quantile, free directions left out.
bool are_consistent(const ChainedPose& a, const ChainedPose& b);

/// The pose of an ambiguous link that can be true if the other statement is; empty if none of them
/// can, or several.
std::optional<Transform> only_consistent_pose(const RegistrationLink& link,
                                              const ChainedPose& expected,
                                              const LinkTolerance& tolerance);
/// Accepts an ambiguous link with one of its poses, as other links decided.
void settle_link(RegistrationLink& link, const Transform& pose);

/// The shortest chain of accepted links from one scan to another, without those in `left_out` (one
/// entry per link); empty if there is none. Adds the links on it to `left_out`.
std::optional<ChainedPose> take_chain(std::span<const RegistrationLink> links, std::size_t source,
                                      std::size_t target, std::vector<bool>& left_out,
                                      const LinkTolerance& tolerance);

/// Holds every link against the loops it closes, chains of accepted links that share no link with
/// each other. An accepted link that two or more chains, and more than agree with it, contradict is
/// rejected, the worst first; an ambiguous one that they lead to a pose of becomes accepted with
/// that pose. Sets `loops` of all links.
void check_loops(std::vector<RegistrationLink>& links, const LinkTolerance& tolerance);

}  // namespace roomscribe
