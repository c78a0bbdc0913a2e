// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/sample_consensus.hpp"
#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// A match of two points, each with its normal, in their own frames.
struct PointMatch {
    Eigen::Vector3d source;
    Eigen::Vector3d target;
    Eigen::Vector3d source_normal;
    Eigen::Vector3d target_normal;
};

/// The rigid motion that brings the sources onto the targets with the least sum of weighted squares
/// (Kabsch; weights all 1 if empty). Empty for fewer than 3 matches or matches on one line.
std::optional<Transform> fit_transform(std::span<const PointMatch> matches,
                                       std::span<const double> weights = {});

struct RejectionSettings {
    double inlier_distance = 0.1;
    ConsensusSettings consensus{.max_iterations = 100'000, .confidence = 0.999};

    void visit(SettingVisitor& visitor) {
        visitor(inlier_distance,
                {.name = "inlier_distance",
                 .unit = "m",
                 .min = 1e-9,
                 .max = 1e6,
                 .doc = "A match is kept if the motion brings its points this close."});
        visitor.group("consensus", consensus);
    }
};

struct RejectionResult {
    std::optional<Transform> target_from_source;
    std::vector<std::uint32_t> inliers;  ///< numbers of the matches that are kept, ascending
    int iterations = 0;
    ConsensusStop stop = ConsensusStop::no_model;
};

/// Sample-consensus rejection (paper, section 3.4): RANSAC over motions from three matches, keeping
/// those matches that satisfy one geometrical transformation; the motion is refitted to them.
RejectionResult reject_by_sample_consensus(std::span<const PointMatch> matches, std::uint64_t seed,
                                           const RejectionSettings& settings = {});

}  // namespace roomscribe
