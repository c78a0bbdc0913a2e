// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/registration/alignment/icp.hpp"
#include "roomscribe/registration/features/correspondence_rejection.hpp"
#include "roomscribe/registration/pair/scan_features.hpp"
#include "roomscribe/reproduction/paper_pair.hpp"

namespace roomscribe {

/// Matches of two scans before and after filtering (section 3.4): every descriptor to its nearest,
/// then sample-consensus rejection. For `fpfh` and `combined` FPFH stands at every tenth point.
struct FilteredMatches {
    std::vector<PointMatch> matches;
    RejectionResult rejection;
};
FilteredMatches match_as_paper(const PaperPair& pair, PairFeatures features, std::uint64_t seed,
                               const Context& context = {});

/// The sensor noise of section 3.5, m.
inline constexpr double paper_sensor_noise = 0.01;

struct PaperAlignment {
    Transform initial_target_from_source = Transform::Identity();
    IcpResult icp;
    /// Equation (2): of a small motion (rotation vector about the origin of the target frame,
    /// translation).
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// The paper's Algorithm 1, "ICP with initial alignment", as it was run there: point-to-point,
/// pairs up to 1 m apart, at most 100 iterations, no verdict. Empty if the matches allow no initial
/// alignment.
std::optional<PaperAlignment> align_by_algorithm_1(const PaperPair& pair, PairFeatures features,
                                                   std::uint64_t seed, const Context& context = {});

}  // namespace roomscribe
