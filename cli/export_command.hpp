// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>

#include "cli/command.hpp"

namespace roomscribe::cli {

void add_export_command(CLI::App& program, Action& action);

}  // namespace roomscribe::cli
