// SPDX-License-Identifier: MIT
#include "cli/interpret_command.hpp"

#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cli/job.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/poses_io.hpp"

namespace roomscribe::cli {
namespace {

std::vector<std::optional<Transform>> load_poses(const JobOptions& options,
                                                 const Context& context) {
    std::vector<std::optional<Transform>> poses;
    for (const std::string& path : options.pose_files) {
        const auto more = read_poses(path, context);
        poses.insert(poses.end(), more.begin(), more.end());
    }
    if (poses.size() != options.inputs.size()) {
        throw IoError(
            options.pose_files.back(), "poses", {},
            fmt::format("there are {} poses for {} scans", poses.size(), options.inputs.size()),
            "give one pose per scan, in the order of the scans");
    }
    return poses;
}

ExitCode interpret(const JobOptions& options, const std::atomic<bool>& cancel) {
    if (options.pose_files.empty() && options.inputs.size() > 1) {
        throw UsageError(
            "interpret takes one cloud, or several with --poses FILE; `roomscribe run` finds the "
            "poses itself");
    }
    const Work work = [&options](std::vector<Scan>& scans, const PipelineSettings& settings,
                                 const Context& context) {
        Reconstruction reconstruction;
        reconstruction.map = options.pose_files.empty()
                                 ? map_of_cloud(std::move(scans.front()))
                                 : merge_scans(scans, load_poses(options, context));
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
    verb.add_option("--poses", options->pose_files,
                    "Where the scans stand: a line of 12 numbers (KITTI) or 8 (TUM) each; may be "
                    "repeated (UOS has a .pose file per scan)")
        ->type_name("FILE")
        ->allow_extra_args(false);
    add_output(verb, *options);
    add_truth(verb, *options);
    add_job_options(verb, *options);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return interpret(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
