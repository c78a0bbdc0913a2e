// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>

#include "cli/command.hpp"

namespace roomscribe::cli {

/// `roomscribe reproduce table1 | table2 | table4 | figure1`: the paper's experiments, its figures
/// beside ours.
void add_reproduce_command(CLI::App& program, Action& action);

}  // namespace roomscribe::cli
