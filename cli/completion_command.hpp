// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>

#include "cli/command.hpp"

namespace roomscribe::cli {

/// Declares `completion`, which prints what completes command lines in bash or zsh. `program` must
/// live until the action has run.
void add_completion_command(CLI::App& program, Action& action);

}  // namespace roomscribe::cli
