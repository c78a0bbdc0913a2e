// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>

namespace roomscribe::cli {

/// What the program returns to the shell.
enum class ExitCode : int {
    done = 0,
    internal_error = 1,
    usage = 2,         ///< the command line, a setting or the settings file is wrong
    input = 3,         ///< a file is missing, malformed, unusable or cannot be written
    no_result = 4,     ///< ran, but placed or found nothing
    interrupted = 130  ///< Ctrl-C
};

/// A command line that CLI11 accepts and the verb does not. The message is one line.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What the chosen verb does, once the whole command line is understood. `cancel` becomes true when
/// the user presses Ctrl-C. A verb has the function
///
///     void add_<verb>_command(CLI::App& program, Action& action);
///
/// which declares its options, and sets `action` when the user chose it.
using Action = std::function<ExitCode(const std::atomic<bool>& cancel)>;

}  // namespace roomscribe::cli
