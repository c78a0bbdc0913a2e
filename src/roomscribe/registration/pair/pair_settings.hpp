// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "roomscribe/core/settings.hpp"
#include "roomscribe/registration/alignment/icp.hpp"
#include "roomscribe/registration/alignment/pose_covariance.hpp"
#include "roomscribe/registration/features/correspondences.hpp"
#include "roomscribe/registration/pair/scan_features.hpp"

namespace roomscribe {

/// How poses are found that the scans then decide between.
enum class InitialAlignment : std::uint8_t {
    sample_consensus,     ///< the paper's: one pose, from matches by sample-consensus rejection
    compatibility_graph,  ///< several poses from matches
    surfaces,             ///< all poses that bring flat surfaces together; else from matches
};

inline std::span<const std::string_view> enumerator_names(InitialAlignment) {
    static constexpr std::array<std::string_view, 3> names{"sample_consensus",
                                                           "compatibility_graph", "surfaces"};
    return names;
}

struct PairRegistrationSettings {
    InitialAlignment initial_alignment = InitialAlignment::surfaces;
    PairFeatures features = PairFeatures::fpfh;
    MatchMethod match_method = MatchMethod::back_and_forth;
    std::optional<double> match_tolerance = {};
    IcpMethod icp_method = IcpMethod::generalized;
    RobustKernel icp_kernel = RobustKernel::tukey;
    PoseCovarianceSettings covariance = {};
    int icp_max_iterations = 100;
    int max_candidates = 16;
    double min_overlap = 0.1;
    double min_agreement = 0.5;
    double min_agreement_alone = 0.65;
    double min_probability = 0.95;

    void visit(SettingVisitor& visitor);
};

}  // namespace roomscribe
