// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "support/run_program.hpp"
#include "support/test_data.hpp"

namespace roomscribe::test {

/// Runs the program that was built with these tests.
ProgramResult roomscribe(const std::vector<std::string>& arguments,
                         const ProgramOptions& options = {});

/// Expects the exit code, nothing on stdout, and one line on stderr that holds all the words.
void expect_error(const ProgramResult& result, int exit_code,
                  const std::vector<std::string>& words);

/// Writes the first `count` scans of a small simulated room as scan1.ply, ... and returns their
/// paths.
std::vector<std::string> write_room_scans(const std::filesystem::path& folder, std::size_t count);

/// Fails the test, and returns null, if the file is no JSON.
nlohmann::json read_json(const std::filesystem::path& path);

std::size_t count_components(const nlohmann::json& scene, const std::string& label);

}  // namespace roomscribe::test
