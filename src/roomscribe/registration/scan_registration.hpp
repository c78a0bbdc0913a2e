// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/derived_value.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/registration/graph/pose_graph.hpp"
#include "roomscribe/registration/graph/scan_graph.hpp"
#include "roomscribe/registration/graph/scan_placement.hpp"
#include "roomscribe/registration/pair/pair_registration.hpp"

namespace roomscribe {

/// Which scans are registered to which.
enum class ScanSequence : std::uint8_t {
    sequential,  ///< the paper's: each scan to the one before, no loop closure
    graph        ///< scans in any order: promising pairs, loops, one optimisation of all poses
};

inline std::span<const std::string_view> enumerator_names(ScanSequence) {
    static constexpr std::array<std::string_view, 2> names{"sequential", "graph"};
    return names;
}

inline std::span<const std::string_view> enumerator_names(KnownPoseUse) {
    static constexpr std::array<std::string_view, 2> names{"prior", "fixed"};
    return names;
}

struct ScanRegistrationSettings {
    ScanSequence sequence = ScanSequence::graph;
    KnownPoseUse known_poses = KnownPoseUse::prior;
    double known_translation = 0.5;
    double known_rotation = 0.0873;
    std::optional<double> coarse_voxel;
    std::optional<double> fine_voxel;
    std::optional<double> fpfh_radius;
    std::optional<double> narf_support;
    PairRegistrationSettings pair;
    ScanGraphSettings graph;
    PoseGraphSettings optimization;

    void visit(SettingVisitor& visitor);
};

struct ScanRegistration {
    Registration registration;
    std::vector<DerivedValue> derived_values;
};

/// Any number of scans, in any order, one frame: that of the first scan of the largest connected
/// set. A scan that no link holds stays without a place; it is never put at the identity in
/// silence. As a graph, the order of the scans decides nothing but the frame and the numbers. As a
/// sequence, every scan is linked to the one before it and to no other, and placed by accepted and
/// ambiguous links. `known_world_from_scan` is empty or has one entry per scan, empty where nothing
/// is known: see KnownPoseUse; a sequence only places by them. Throws InvalidArgument if there are
/// no scans, or another number of known poses.
ScanRegistration register_scans(std::span<const Scan> scans,
                                std::span<const std::optional<Transform>> known_world_from_scan,
                                std::uint64_t seed, const ScanRegistrationSettings& settings = {},
                                const Context& context = {});

/// The same where no pose is known.
ScanRegistration register_scans(std::span<const Scan> scans, std::uint64_t seed,
                                const ScanRegistrationSettings& settings = {},
                                const Context& context = {});

}  // namespace roomscribe
