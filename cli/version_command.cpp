// SPDX-License-Identifier: MIT
#include "cli/version_command.hpp"

#include <string>

#include <fmt/format.h>

#include "roomscribe/report/viewer_bundle.hpp"

namespace roomscribe::cli {

void add_version_command(CLI::App& program, Action& action) {
    program.add_subcommand("version", "Print the version, and whether reports have a 3D view")
        ->callback([&action] {
            action = [](const std::atomic<bool>&) {
                const std::string libraries = viewer_libraries();
                fmt::print("roomscribe {}\n3D view of reports: {}\n", ROOMSCRIBE_VERSION,
                           libraries.empty() ? "none; ./dev viewer installs what it is built with"
                                             : libraries);
                return ExitCode::done;
            };
        });
}

}  // namespace roomscribe::cli
