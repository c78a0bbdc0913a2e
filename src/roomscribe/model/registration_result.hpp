// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

enum class LinkVerdict : std::uint8_t {
    accepted,
    ambiguous,  ///< a rival pose explains the scans about as well
    rejected    ///< no pose that the scans support
};
std::string_view link_verdict_name(LinkVerdict verdict);

/// What is known of the relative pose of two scans.
struct RegistrationLink {
    std::size_t source = 0;
    std::size_t target = 0;
    Transform target_from_source = Transform::Identity();
    LinkVerdict verdict = LinkVerdict::rejected;
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
    std::optional<Transform> rival;  ///< the other pose, when ambiguous
    std::string_view stop_reason;    ///< of the last refinement
};

/// All scans in one frame: that of the first scan.
struct Registration {
    /// Per scan; empty for a scan that has no accepted or ambiguous chain of links to the first.
    std::vector<std::optional<Transform>> map_from_scan;
    std::vector<RegistrationLink> links;
    std::vector<double> residuals;  ///< m per scan: RMSE over its links, NaN where it has none
};

}  // namespace roomscribe
