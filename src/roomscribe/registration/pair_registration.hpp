// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/registration/icp.hpp"
#include "roomscribe/registration/prepared_scan.hpp"

namespace roomscribe {

/// How poses are found from descriptor matches.
enum class InitialAlignment : std::uint8_t {
    sample_consensus,     ///< the paper's: one pose, by sample-consensus rejection
    compatibility_graph,  ///< several poses, the scans decide between them
};

inline std::span<const std::string_view> enumerator_names(InitialAlignment) {
    static constexpr std::array<std::string_view, 2> names{"sample_consensus",
                                                           "compatibility_graph"};
    return names;
}

struct PairRegistrationSettings {
    InitialAlignment initial_alignment = InitialAlignment::compatibility_graph;
    IcpMethod icp_method = IcpMethod::point_to_plane;
    int icp_max_iterations = 100;
    int max_candidates = 12;
    double min_overlap = 0.2;
    double min_agreement = 0.5;
    double min_agreement_alone = 0.65;
    double max_contradiction = 0.1;
    double min_lead = 0.12;

    void visit(SettingVisitor& visitor);
};

/// Two scans without any guess (the paper's Algorithm 1 and beyond): matches, candidate poses,
/// verification of each against both scans, refinement by ICP, verdict. The link's scan numbers are
/// left 0. A pair without overlap comes back rejected, with the best pose that was found.
RegistrationLink register_pair(const PreparedScan& source, const PreparedScan& target,
                               const RegistrationScale& scale, std::uint64_t seed,
                               const PairRegistrationSettings& settings = {},
                               const Context& context = {});

}  // namespace roomscribe
