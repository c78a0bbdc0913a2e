// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace roomscribe::cli {

/// Whether a path is what run, register or interpret left: a folder with scene.json or
/// registration.json.
bool is_result_folder(const std::filesystem::path& path);

/// What a result tells of the things with these ids (components, rooms, scans by their names), or
/// of all in a line each if none is given. Throws UsageError for an id that is not there, with the
/// nearest ones that are; IoError for a file that cannot be read.
std::string explain_result(const std::filesystem::path& folder, std::span<const std::string> ids,
                           bool as_json);

}  // namespace roomscribe::cli
