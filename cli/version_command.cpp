// SPDX-License-Identifier: MIT
#include "cli/version_command.hpp"

#include <fmt/format.h>

namespace roomscribe::cli {

void add_version_command(CLI::App& program, Action& action) {
    program.add_subcommand("version", "Print the version")->callback([&action] {
        action = [](const std::atomic<bool>&) {
            fmt::print("roomscribe {}\n", ROOMSCRIBE_VERSION);
            return ExitCode::done;
        };
    });
}

}  // namespace roomscribe::cli
