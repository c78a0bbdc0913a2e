// SPDX-License-Identifier: MIT
#include "cli/interpret_command.hpp"

#include <memory>
#include <utility>

#include "cli/job.hpp"

namespace roomscribe::cli {
namespace {

ExitCode interpret(const JobOptions& options, const std::atomic<bool>& cancel) {
    if (options.pose_files.empty() && options.inputs.size() > 1) {
        throw UsageError(
            "interpret takes one cloud, or several with --poses FILE; `roomscribe run` finds the "
            "poses itself");
    }
    const Work work = [](std::vector<Scan>& scans, KnownPoses poses,
                         const PipelineSettings& settings, const Context& context) {
        Reconstruction reconstruction;
        reconstruction.map =
            poses.empty() ? map_of_cloud(std::move(scans.front())) : merge_scans(scans, poses);
        interpret_map(reconstruction, settings, context);
        return reconstruction;
    };
    return run_job("interpret", options, cancel, work);
}

}  // namespace

void add_interpret_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<JobOptions>();
    CLI::App& verb = *program.add_subcommand(
        "interpret", "A registered cloud, or scans with poses -> labels and model");
    add_scans(verb, *options);
    add_poses(verb, *options);
    add_output(verb, *options);
    add_truth(verb, *options);
    add_job_options(verb, *options);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return interpret(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
