// SPDX-License-Identifier: MIT
#include "cli/interpret_command.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "cli/job.hpp"
#include "roomscribe/io/point_cloud_io.hpp"

namespace roomscribe::cli {
namespace {

bool has_all(KnownPoses poses) {
    return std::all_of(poses.begin(), poses.end(),
                       [](const auto& pose) { return pose.has_value(); });
}

[[noreturn]] void fail_without_poses() {
    throw UsageError(
        "interpret takes one cloud, or several whose files hold their poses (E57, PTX) or with "
        "--poses FILE; `roomscribe run` finds the poses itself");
}

/// The scans by the poses of --poses, else by those of their files.
ScanMap make_map(JobInput& input) {
    if (!input.given_poses.empty()) return merge_scans(std::move(input.scans), input.given_poses);
    if (has_all(input.stored_poses)) {
        ScanMap map = merge_scans(std::move(input.scans), input.stored_poses);
        map.cloud.global_shift = input.map_shift;
        return map;
    }
    if (input.scans.size() > 1) fail_without_poses();
    return map_of_cloud(std::move(input.scans.front()));
}

ExitCode interpret(const JobOptions& options, const std::atomic<bool>& cancel) {
    // Told before long reading, where the names tell it.
    const auto may_hold_pose = [](const std::string& path) { return may_hold_poses(path); };
    if (options.pose_files.empty() && options.inputs.size() > 1 &&
        !std::all_of(options.inputs.begin(), options.inputs.end(), may_hold_pose)) {
        fail_without_poses();
    }
    const Work work = [](JobInput& input, const PipelineSettings& settings,
                         const Context& context) {
        Reconstruction reconstruction;
        reconstruction.map = make_map(input);
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
    add_memory(verb, *options);
    add_corrections(verb, *options);
    add_truth(verb, *options);
    add_job_options(verb, *options);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return interpret(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
