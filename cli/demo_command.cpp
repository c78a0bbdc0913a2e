// SPDX-License-Identifier: MIT
#include "cli/demo_command.hpp"

#include <filesystem>
#include <memory>
#include <utility>

#include "cli/job.hpp"
#include "cli/output_folder.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/pipeline/truth_folder.hpp"
#include "roomscribe/simulation/scenario_json.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe::cli {
namespace {

/// An office scanned as the paper did it: four stops of a robot with a tilting SICK LMS200.
constexpr std::uint64_t demo_seed = 5;
constexpr SceneOptions demo_options{
    .scanner = ScannerKind::sick_lms200, .scans_per_room = 4, .coarseness = 1.0};

ExitCode demo(JobOptions options, const std::atomic<bool>& cancel) {
    resolve_settings(options);  // A wrong setting is to leave no files.
    const OutputFolder office(std::filesystem::path(options.output) / "office");
    {
        ProgressDisplay display(options.progress);
        const Context context = make_context(options, cancel, display);
        const Scenario scenario = plan_scene(SceneKind::office, demo_seed, demo_options);
        const SimulatedScene scene = simulate_scene(scenario, context);
        write_truth_folder(office.path(), scene.truth, scene.scans, context);
        write_file(office.path() / "scenario.json", "scenario", scenario_to_json(scenario));
        for (const Scan& scan : scene.scans)
            options.inputs.push_back((office.path() / "scans" / scan.name).string());
    }
    options.truth = office.path().string();
    return run_job("run", options, cancel,
                   [](JobInput& input, const PipelineSettings& settings, const Context& context) {
                       return reconstruct(std::move(input.scans), settings, context);
                   });
}

}  // namespace

void add_demo_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<JobOptions>();
    options->output = "roomscribe-demo";
    CLI::App& verb = *program.add_subcommand(
        "demo", "Scan a made-up office into FOLDER/office, run on the scans and score the result");
    add_output(verb, *options);
    verb.get_option("--output")->required(false)->capture_default_str();
    add_job_options(verb, *options);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return demo(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
