// SPDX-License-Identifier: MIT
#include "cli/register_command.hpp"

#include <memory>
#include <utility>

#include "cli/job.hpp"

namespace roomscribe::cli {

void add_register_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<JobOptions>();
    CLI::App& verb = *program.add_subcommand("register", "Scans -> poses and one map");
    add_scans(verb, *options);
    add_poses(verb, *options);
    add_output(verb, *options);
    add_memory(verb, *options);
    add_resume(verb, *options);
    add_truth(verb, *options);
    add_job_options(verb, *options);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) {
            return run_job(
                "register", *options, cancel,
                [](JobInput& input, const PipelineSettings& settings, const Context& context) {
                    return register_to_map(std::move(input.scans), settings, context,
                                           input.given_poses);
                });
        };
    });
}

}  // namespace roomscribe::cli
