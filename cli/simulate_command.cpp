// SPDX-License-Identifier: MIT
#include "cli/simulate_command.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/choice_option.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress_display.hpp"
#include "roomscribe/core/context.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/pipeline/truth_folder.hpp"
#include "roomscribe/simulation/scenario_json.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe::cli {
namespace {

struct SimulateOptions {
    std::string kind;  ///< of scene, or a scenario file
    std::string output;
    std::uint64_t seed = 1;
    SceneOptions scene;
    bool has_scene_options = false;
    bool is_plan_only = false;
    int num_threads = 0;
};

Scenario resolve_scenario(const SimulateOptions& options) {
    const auto found = std::find(scene_kind_names.begin(), scene_kind_names.end(), options.kind);
    if (found != scene_kind_names.end()) {
        return plan_scene(static_cast<SceneKind>(found - scene_kind_names.begin()), options.seed,
                          options.scene);
    }
    if (std::filesystem::path(options.kind).extension() != ".json") {
        throw UsageError(fmt::format("KIND is \"{}\", must be one of {}, or a scenario.json",
                                     options.kind, fmt::join(scene_kind_names, ", ")));
    }
    if (options.has_scene_options) {
        throw UsageError(
            "a scenario.json has its own seed, scanner, stations and coarseness: "
            "change them there");
    }
    const MappedFile file(options.kind, "scenario");
    return scenario_from_json(file.text(), options.kind);
}

ExitCode simulate(const SimulateOptions& options, const std::atomic<bool>& cancel) {
    const Scenario scenario = resolve_scenario(options);
    const OutputFolder output(options.output);
    std::size_t num_points = 0;
    if (!options.is_plan_only) {
        ProgressDisplay display(ProgressMode::automatic);
        Context context;
        context.num_threads = options.num_threads;
        context.cancel = &cancel;
        context.on_progress = [&display](std::string_view stage, double fraction) {
            display.show(stage, fraction);
        };
        const SimulatedScene scene = simulate_scene(scenario, context);
        write_truth_folder(output.path(), scene.truth, scene.scans, context);
        num_points = scene.truth.map.cloud.size();
    }
    write_file(output.path() / "scenario.json", "scenario", scenario_to_json(scenario));
    fmt::print("{}: {} rooms, {} scans, {} rays\n", output.path().string(), scenario.rooms.size(),
               scenario.stations.size(), num_points);
    return ExitCode::done;
}

}  // namespace

void add_simulate_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<SimulateOptions>();
    CLI::App& verb = *program.add_subcommand(
        "simulate", "Make up a furnished place, scan it, and write the scans with their truth");
    verb.add_option("KIND", options->kind,
                    fmt::format("{}, or a scenario.json", fmt::join(scene_kind_names, ", ")))
        ->type_name("")
        ->required();
    verb.add_option("-o,--output", options->output,
                    "Folder for scans, map, truth and scenario.json")
        ->type_name("FOLDER")
        ->required();
    verb.add_option("--seed", options->seed, "The same seed gives the same files")
        ->type_name("N")
        ->capture_default_str();
    add_choice_option<ScannerKind>(verb, "--scanner", options->scene.scanner,
                                   words_of<ScannerKind>(scanner_kind_names),
                                   fmt::format("{}", fmt::join(scanner_kind_names, ", ")))
        ->type_name("NAME");
    verb.add_option("--scans", options->scene.scans_per_room,
                    "In each room; 0: as many as the scanner needs to see it whole")
        ->type_name("N")
        ->capture_default_str();
    verb.add_option("--coarseness", options->scene.coarseness,
                    "Factor on the scanner's angular steps")
        ->type_name("X")
        ->capture_default_str();
    verb.add_flag("--plan", options->is_plan_only,
                  "Write scenario.json alone: edit it, then simulate it");
    verb.add_option("--threads", options->num_threads, "0: all of the machine's")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    verb.callback([options, &verb, &action] {
        for (const char* name : {"--seed", "--scanner", "--scans", "--coarseness"})
            options->has_scene_options |= verb.count(name) > 0;
        action = [options](const std::atomic<bool>& cancel) { return simulate(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
