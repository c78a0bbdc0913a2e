// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomscribe::test {

struct ProgramResult {
    int exit_code = -1;  ///< 128 + signal if a signal ended the program
    std::string out;
    std::string err;
    std::size_t peak_memory = 0;  ///< bytes
    bool timed_out = false;       ///< and was killed
};

struct ProgramOptions {
    std::chrono::seconds timeout{180};
    /// Sends SIGINT as soon as the program has written something to stderr.
    bool interrupt_at_first_message = false;
    /// Sends SIGKILL at that time after the start, unless the program has ended by then.
    std::optional<std::chrono::steady_clock::duration> kill_after = std::nullopt;
    /// Sends SIGKILL as soon as there is a file of that name.
    std::filesystem::path kill_at_file = {};
};

/// Runs a program to its end, with no standard input.
ProgramResult run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const ProgramOptions& options = {});

/// All bytes of a file; empty if there is none.
std::string read_bytes(const std::filesystem::path& path);

}  // namespace roomscribe::test
