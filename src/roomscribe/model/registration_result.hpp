// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

enum class LinkVerdict : std::uint8_t {
    accepted,
    ambiguous,  ///< too little speaks for the pose, or as much for a rival
    rejected    ///< no pose that the scans support
};
std::string_view link_verdict_name(LinkVerdict verdict);

/// What the loops through a link say of it: chains of accepted links that lead from its source to
/// its target another way.
enum class LoopCheck : std::uint8_t {
    none,       ///< there is no other way
    agrees,     ///< the other ways lead to the same pose
    disagrees,  ///< they lead elsewhere: this is why an accepted link was taken back
    resolved    ///< the link was ambiguous, and they lead to one of its poses, which it now has
};
std::string_view loop_check_name(LoopCheck check);

/// What is known of the relative pose of two scans.
struct RegistrationLink {
    std::size_t source = 0;
    std::size_t target = 0;
    Transform target_from_source = Transform::Identity();
    LinkVerdict verdict = LinkVerdict::rejected;
    double probability = 0.0;  ///< that the pose is right, in [0, 1]
    LoopCheck loops = LoopCheck::none;
    /// Share of both scans' points that lie on or near the other's surface, in [0, 1].
    double overlap = 0.0;
    /// Of the points on which the other scan has a say, the share that it confirms, in [0, 1].
    double agreement = 0.0;
    double rmse = 0.0;  ///< m, over the inliers
    std::size_t inliers = 0;
    /// Of target_from_source: (rotation vector, translation), rad2 / rad m / m2.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    /// Unit twists (rotation vector, translation) along which the scans slide freely.
    std::vector<Eigen::Matrix<double, 6, 1>> unobservable;
    /// The other poses that the scans bear out, the likeliest first, when ambiguous.
    std::vector<Transform> rivals;
    std::string stop_reason;  ///< of the last refinement
};

/// Scans in one frame: that of the first scan of the largest connected set, or that of known poses
/// that were kept.
struct Registration {
    /// Per scan; empty for a scan that no chain of links leads to.
    std::vector<std::optional<Transform>> map_from_scan;
    /// Per scan that has no place in the map: its pose in the frame of its component's first scan.
    /// Empty for the scans of the map.
    std::vector<std::optional<Transform>> apart_from_scan;
    /// Per scan, of its pose, as in RegistrationLink: its variance along a direction that no link
    /// holds is that of knowing nothing, 1e6 (rad2 or m2). Zero for a scan that defines a frame.
    std::vector<Eigen::Matrix<double, 6, 6>> covariances;
    /// Per scan: it has its pose only by way of an ambiguous link.
    std::vector<bool> is_doubtful;
    std::vector<RegistrationLink> links;
    /// Scans that links join, ascending; the largest set comes first, then the others by their
    /// first scan. More than one: there are several maps, and nobody knows how they lie to each
    /// other.
    std::vector<std::vector<std::size_t>> components;
    std::vector<double> residuals;  ///< m per scan: RMSE over its links, NaN where it has none
    std::vector<double> overlaps;   ///< per scan: the largest over its links, 0 where it has none
};

}  // namespace roomscribe
