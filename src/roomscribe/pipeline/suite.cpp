// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/suite.hpp"

#include <chrono>

#include <fmt/format.h>

#include "roomscribe/pipeline/reconstruct.hpp"
#include "roomscribe/pipeline/scoring.hpp"

namespace roomscribe {
namespace {

/// Angular steps of a scan that a robot or a surveyor in a hurry would take: 0.45 degrees for the
/// terrestrial scanner, whose full 0.15 would make a floor of 18 stations 45 million points.
SceneOptions options_of(ScannerKind scanner, int scans_per_room = 0) {
    return {.scanner = scanner,
            .scans_per_room = scans_per_room,
            .coarseness = scanner == ScannerKind::terrestrial ? 3.0 : 1.0};
}

using enum SceneKind;
using enum ScannerKind;

std::vector<SuiteScene> quick_scenes() {
    return {
        {office, 1, options_of(sick_lms200, 4)},     {kitchen, 1, options_of(hokuyo_utm30lx, 3)},
        {l_room, 1, options_of(terrestrial)},        {flat, 1, options_of(terrestrial, 1)},
        {room, 1, options_of(structured_light, 10)}, {corridor, 1, options_of(spinning_lidar, 2)}};
}

std::vector<SuiteScene> paper_scenes() {
    return {
        {office, 2, options_of(sick_lms200, 4)},      {office, 3, options_of(sick_lms200, 4)},
        {office, 4, options_of(sick_lms200, 1)},      {office, 5, options_of(sick_lms200, 1)},
        {room, 6, options_of(sick_lms200, 1)},        {kitchen, 7, options_of(hokuyo_utm30lx, 4)},
        {office, 8, options_of(hokuyo_utm30lx, 4)},   {kitchen, 9, options_of(hokuyo_utm30lx, 1)},
        {kitchen, 10, options_of(hokuyo_utm30lx, 1)}, {kitchen, 11, options_of(hokuyo_utm30lx, 1)},
        {office, 12, options_of(hokuyo_utm30lx, 1)},  {office, 13, options_of(hokuyo_utm30lx, 1)},
        {room, 14, options_of(hokuyo_utm30lx, 1)}};
}

std::vector<SuiteScene> full_scenes() {
    std::vector<SuiteScene> scenes;
    std::uint64_t seed = 20;
    for (const SceneKind kind : {room, l_room, slanted, office, kitchen, corridor, flat}) {
        for (const ScannerKind scanner :
             {sick_lms200, hokuyo_utm30lx, terrestrial, spinning_lidar}) {
            // A robot with a slow scanner does not stop 24 times in a flat.
            const int scans = kind == flat && scanner != terrestrial ? 2 : 0;
            scenes.push_back({kind, seed++, options_of(scanner, scans)});
            scenes.push_back({kind, seed++, options_of(scanner, scans)});
        }
    }
    for (const SceneKind kind : {room, office, kitchen}) {
        scenes.push_back({kind, seed++, options_of(structured_light, 12)});
        scenes.push_back({kind, seed++, options_of(structured_light, 8)});
    }
    scenes.push_back({floor, seed++, options_of(terrestrial, 1)});
    scenes.push_back({floor, seed++, options_of(spinning_lidar, 1)});
    return scenes;
}

std::vector<SuiteScene> register_scenes() {
    std::vector<SuiteScene> scenes;
    std::uint64_t seed = 100;
    for (const ScannerKind scanner :
         {sick_lms200, hokuyo_utm30lx, terrestrial, structured_light, spinning_lidar}) {
        const bool is_frame = scanner == structured_light;
        for (const SceneKind kind : {room, l_room, slanted, office, kitchen, corridor}) {
            scenes.push_back({kind, seed++, options_of(scanner, is_frame ? 8 : 4)});
        }
        scenes.push_back({office, seed++, options_of(scanner, is_frame ? 12 : 3)});
        scenes.push_back(
            {is_frame ? kitchen : flat, seed++, options_of(scanner, is_frame ? 12 : 2)});
    }
    return scenes;
}

class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

std::string suite_scene_name(const SuiteScene& scene) {
    return fmt::format("{}-{} {}", scene_kind_names[static_cast<std::size_t>(scene.kind)],
                       scene.seed,
                       scanner_kind_names[static_cast<std::size_t>(scene.options.scanner)]);
}

std::vector<SuiteScene> suite_scenes(SuiteName suite, std::uint64_t series) {
    std::vector<SuiteScene> scenes;
    switch (suite) {
        case SuiteName::quick:
            scenes = quick_scenes();
            break;
        case SuiteName::paper:
            scenes = paper_scenes();
            break;
        case SuiteName::full:
            scenes = full_scenes();
            break;
        case SuiteName::registration:
            scenes = register_scenes();
            break;
    }
    for (SuiteScene& scene : scenes)
        scene.seed += 1000 * series;
    return scenes;
}

SuiteSceneResult run_suite_scene(const SuiteScene& scene, bool registers_only,
                                 const PipelineSettings& settings, const Context& context) {
    SuiteSceneResult result;
    const Stopwatch simulation;
    const SimulatedScene simulated =
        simulate_scene(plan_scene(scene.kind, scene.seed, scene.options), context);
    result.simulation_seconds = simulation.seconds();
    result.num_scans = simulated.scans.size();
    result.num_points = simulated.truth.map.cloud.size();

    const Stopwatch run;
    const Reconstruction found = registers_only
                                     ? register_to_map(simulated.scans, settings, context)
                                     : reconstruct(simulated.scans, settings, context);
    result.run_seconds = run.seconds();
    result.from_scans = score_reconstruction(simulated.truth, found, context);
    if (registers_only) return result;

    Reconstruction registered;
    registered.map = simulated.truth.map;
    interpret_map(registered, settings, context);
    result.from_true_poses = score_reconstruction(simulated.truth, registered, context);
    return result;
}

std::vector<Evaluation> compare_interpretations(const SuiteScene& scene,
                                                std::span<const InterpretationMethod> methods,
                                                const Context& context) {
    const SimulatedScene simulated =
        simulate_scene(plan_scene(scene.kind, scene.seed, scene.options), context);
    PipelineSettings settings;
    const Reconstruction registered = register_to_map(simulated.scans, settings, context);
    std::vector<Evaluation> evaluations;
    for (const InterpretationMethod method : methods) {
        settings.interpretation.method = method;
        Reconstruction interpreted = registered;
        interpret_map(interpreted, settings, context);
        evaluations.push_back(score_reconstruction(simulated.truth, interpreted, context));
    }
    return evaluations;
}

}  // namespace roomscribe
