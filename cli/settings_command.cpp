// SPDX-License-Identifier: MIT
#include "cli/settings_command.hpp"

#include <memory>

#include <fmt/format.h>

#include "cli/settings_file.hpp"

namespace roomscribe::cli {
namespace {

struct PrintOptions {
    bool markdown = false;
    bool toml = false;
};

}  // namespace

void add_settings_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<PrintOptions>();
    CLI::App& verb = *program.add_subcommand("settings", "Print all settings");
    CLI::Option* markdown =
        verb.add_flag("--markdown", options->markdown, "As a table for the documentation");
    verb.add_flag("--toml", options->toml, "As a file for --config")->excludes(markdown);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>&) {
            fmt::print("{}", options->markdown ? settings_markdown()
                             : options->toml   ? settings_toml()
                                               : settings_table());
            return ExitCode::done;
        };
    });
}

}  // namespace roomscribe::cli
