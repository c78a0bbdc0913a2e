// SPDX-License-Identifier: MIT
#include "cli/demo_command.hpp"

#include <filesystem>
#include <memory>

#include "cli/demo_room.hpp"
#include "cli/job.hpp"
#include "cli/output_folder.hpp"
#include "roomscribe/io/point_cloud_io.hpp"

namespace roomscribe::cli {
namespace {

ExitCode demo(JobOptions options, const std::atomic<bool>& cancel) {
    resolve_settings(options);  // A wrong setting is to leave no files.
    const OutputFolder scan_folder(std::filesystem::path(options.output) / "scans");
    for (const Scan& scan : scan_demo_room()) {
        const std::filesystem::path path = scan_folder.path() / scan.name;
        write_point_cloud(path, scan.cloud);
        options.inputs.push_back(path.string());
    }
    return run_job("run", options, cancel,
                   [](std::vector<Scan>& scans, const PipelineSettings& settings,
                      const Context& context) { return reconstruct(scans, settings, context); });
}

}  // namespace

void add_demo_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<JobOptions>();
    options->output = "roomscribe-demo";
    CLI::App& verb = *program.add_subcommand(
        "demo", "Scan a small made-up room into FOLDER/scans, and run on these scans");
    add_output(verb, *options);
    verb.get_option("--output")->required(false)->capture_default_str();
    add_job_options(verb, *options);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return demo(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
