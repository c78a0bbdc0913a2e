// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/evaluate.hpp"
#include "roomscribe/pipeline/pipeline_settings.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe {

/// Scenes that are made, run and scored together.
enum class SuiteName : std::uint8_t {
    quick,  ///< 6 scenes, one per scanner and two for the terrestrial one
    paper,  ///< 13 as in the paper's Table 4: 4 complete rooms and 9 single scans, 8 of them by the
            ///< Hokuyo and 5 by the SICK
    full,   ///< 64: all kinds, scanners and several seeds
    registration  ///< 40 sequences of scans, registered only
};
inline constexpr std::array<std::string_view, 4> suite_names{"quick", "paper", "full", "register"};

struct SuiteScene {
    SceneKind kind = SceneKind::room;
    std::uint64_t seed = 1;
    SceneOptions options;
};

/// "office-3 sick_lms200"
std::string suite_scene_name(const SuiteScene& scene);

/// The scenes of a suite. Another `series` has the same kinds and scanners, and buildings that were
/// never seen.
std::vector<SuiteScene> suite_scenes(SuiteName suite, std::uint64_t series = 0);

struct SuiteSceneResult {
    std::size_t num_scans = 0;
    std::size_t num_points = 0;
    double simulation_seconds = 0.0;
    double run_seconds = 0.0;  ///< of reconstruct(), or register_to_map()
    Evaluation from_scans;     ///< as `run` does it: nothing known but the scans
    /// As `interpret --poses`: what interpretation is worth where registration is none of its
    /// worries. Empty where the suite registers only.
    std::optional<Evaluation> from_true_poses;
};

/// Makes a scene, runs it with these settings, and holds the results against truth.
SuiteSceneResult run_suite_scene(const SuiteScene& scene, bool registers_only,
                                 const PipelineSettings& settings = {},
                                 const Context& context = {});

/// Makes a scene, registers its scans once, and holds what each of the methods makes of the map
/// against truth: one evaluation per method.
std::vector<Evaluation> compare_interpretations(const SuiteScene& scene,
                                                std::span<const InterpretationMethod> methods,
                                                const Context& context = {});

}  // namespace roomscribe
