// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>

#include "cli/command.hpp"

namespace roomscribe::cli {

/// Declares `view`: the report of a result in a browser, with all its points.
void add_view_command(CLI::App& program, Action& action);

}  // namespace roomscribe::cli
