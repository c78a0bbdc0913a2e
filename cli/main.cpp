// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/completion_command.hpp"
#include "cli/convert_command.hpp"
#include "cli/demo_command.hpp"
#include "cli/evaluate_command.hpp"
#include "cli/explain_command.hpp"
#include "cli/export_command.hpp"
#include "cli/info_command.hpp"
#include "cli/interpret_command.hpp"
#include "cli/interrupt.hpp"
#include "cli/man_command.hpp"
#include "cli/register_command.hpp"
#include "cli/reproduce_command.hpp"
#include "cli/run_command.hpp"
#include "cli/settings_command.hpp"
#include "cli/simulate_command.hpp"
#include "cli/suite_command.hpp"
#include "cli/version_command.hpp"
#include "cli/view_command.hpp"
#include "roomscribe/core/error.hpp"

namespace roomscribe::cli {
namespace {

constexpr const char* exit_code_help =
    "Results go to stdout, progress and errors to stderr. Exit codes: 0 done, 2 usage,\n"
    "3 input or output file, 4 ran but placed or found nothing, 130 interrupted, 1 our bug.\n"
    "`roomscribe VERB --help` has the options of a verb and all settings.\n";

/// One line, whatever the text.
ExitCode fail(ExitCode code, std::string_view text) {
    std::string line(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::fflush(stdout);
    fmt::print(stderr, "roomscribe: {}\n", line);
    return code;
}

void declare_verbs(CLI::App& program, Action& action) {
    program.name("roomscribe");
    program.set_version_flag("--version", "roomscribe " ROOMSCRIBE_VERSION);
    program.require_subcommand(0, 1);
    program.footer(exit_code_help);
    add_run_command(program, action);
    add_register_command(program, action);
    add_interpret_command(program, action);
    add_convert_command(program, action);
    add_info_command(program, action);
    add_explain_command(program, action);
    add_export_command(program, action);
    add_view_command(program, action);
    add_evaluate_command(program, action);
    add_simulate_command(program, action);
    add_suite_command(program, action);
    add_reproduce_command(program, action);
    add_demo_command(program, action);
    add_settings_command(program, action);
    add_version_command(program, action);
    add_completion_command(program, action);
    add_man_command(program, action);
}

ExitCode run_program(int argc, char** argv) {
    CLI::App program("Scans in, a described room out.");
    Action action;
    declare_verbs(program, action);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // Help and version are "errors" with exit code 0 to CLI11.
        if (error.get_exit_code() != 0) {
            return fail(ExitCode::usage, std::string(error.what()) + "; see roomscribe --help");
        }
        program.exit(error);
        return ExitCode::done;
    }
    if (!action) {
        fmt::print("{}", program.help());
        return ExitCode::done;
    }
    const ExitCode code = action(catch_interrupt());
    if (std::fflush(stdout) != 0)
        return fail(ExitCode::input, "standard output: cannot be written");
    return code;
}

}  // namespace
}  // namespace roomscribe::cli

int main(int argc, char** argv) {
    namespace cli = roomscribe::cli;
    using cli::ExitCode;
    ExitCode code = ExitCode::internal_error;
    try {
        code = cli::run_program(argc, argv);
    } catch (const roomscribe::Cancelled&) {
        code = cli::fail(ExitCode::interrupted, "interrupted");
    } catch (const cli::UsageError& error) {
        code = cli::fail(ExitCode::usage, error.what());
    } catch (const roomscribe::InvalidArgument& error) {
        code = cli::fail(ExitCode::usage, error.what());
    } catch (const roomscribe::IoError& error) {
        code = cli::fail(ExitCode::input, error.what());
    } catch (const std::bad_alloc&) {
        code = cli::fail(code, "out of memory");
    } catch (const std::exception& error) {
        code = cli::fail(code, std::string("internal error: ") + error.what());
    }
    return static_cast<int>(code);
}
