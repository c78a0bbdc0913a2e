// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/alignment/closest_points.hpp"
#include "roomscribe/registration/alignment/icp.hpp"

namespace roomscribe {

/// A source point under a motion, and the target point it is paired with.
struct IcpPair {
    Eigen::Vector3d moved;
    Eigen::Vector3d offset;         ///< moved - target
    Eigen::Vector3d target_normal;  ///< zero if the method does not look at it
    Eigen::Vector3d source_normal;  ///< under the motion; zero if the method does not look at it

    /// How generalised ICP measures offsets: offset^T metric offset is the squared residual in m2.
    /// The inverse of both surfaces' covariances, diag(epsilon, 1, 1) along and across their
    /// normals, times 2 epsilon: where the normals agree, that is the squared distance along them.
    Eigen::Matrix3d generalized_metric() const;
    /// m, what the method minimises: signed for point_to_plane.
    double residual(IcpMethod method) const;
    double offset_along_surface() const;  ///< m, across the target's normal
};

/// The pairs of all source points under a motion, and how much each counts.
class IcpPairing {
  public:
    /// Keeps what it is given by reference. Throws InvalidArgument if the method's normals are
    /// missing.
    IcpPairing(const IcpSource& source, const IcpTarget& target, const IcpSettings& settings);

    /// Step 5 of the paper's Algorithm 1: pairs every source point with its closest target point.
    void update(const Transform& target_from_source, double reach, const Context& context);

    const Transform& pose() const { return pose_; }
    std::size_t num_sources() const { return targets_.size(); }
    bool has_pair(std::size_t i) const { return targets_[i] != ClosestPoints::none; }
    std::uint32_t target_of(std::size_t i) const { return targets_[i]; }
    IcpPair pair(std::size_t i) const;
    double residual(std::size_t i) const { return static_cast<double>(residuals_[i]); }
    /// Of a source point's pair, at least 0; 0 if it has none.
    double weight(std::size_t i) const;
    /// m, robust standard deviation of the residuals.
    double scale() const { return scale_; }
    /// m, robust standard deviation of the distances of the paired points.
    double distance_scale() const;

  private:
    void pair_range(std::size_t begin, std::size_t end, float reach);
    IcpPair pair_with(std::size_t i, std::uint32_t target) const;

    const IcpSource& source_;
    const IcpTarget& target_;
    const IcpSettings& settings_;
    ClosestPoints closest_points_;
    Transform pose_ = Transform::Identity();
    std::vector<std::uint32_t> targets_;  ///< per source point
    std::vector<float> residuals_;        ///< m, per source point
    std::vector<float> precisions_;       ///< per source point; empty: all 1
    double typical_variance_ = 0.0;       ///< m2, of a pair, where deviations are given
    double scale_ = 0.0;
    double largest_kept_ = 0.0;  ///< m, residuals up to this are not trimmed
};

}  // namespace roomscribe
