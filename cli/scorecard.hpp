// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace roomscribe::cli {

/// A Markdown file with one part per suite, each under a heading of the second level. Puts `part`,
/// which begins with its heading, in the place of the part with the same heading, else at the end;
/// all else stays. A file that is not there is begun. Throws IoError if it cannot be written.
void update_scorecard(const std::filesystem::path& path, std::string_view part);

/// Processor, number of threads, date: what a time in a scorecard depends on.
std::string describe_machine();

}  // namespace roomscribe::cli
