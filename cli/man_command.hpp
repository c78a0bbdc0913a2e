// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>

#include "cli/command.hpp"

namespace roomscribe::cli {

/// Declares `man`, which prints the manual page. `program` must live until the action has run.
void add_man_command(CLI::App& program, Action& action);

}  // namespace roomscribe::cli
