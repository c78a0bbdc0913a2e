// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "roomscribe/pipeline/pipeline_settings.hpp"

namespace roomscribe::cli {

/// One paragraph on the format, for --help.
extern const char* const settings_file_help;

/// Sets what the file says. Lines are `name = value`, `[group]` (prefixed to the names below it),
/// `# comment` or empty: the part of TOML that settings need. Throws IoError if the file cannot be
/// read, UsageError with the line for anything else.
void apply_settings_file(PipelineSettings& settings, const std::string& path);

/// Sets "name=value". Throws UsageError if there is no '=', InvalidArgument as set_setting does.
void apply_assignment(PipelineSettings& settings, const std::string& assignment);

/// All settings as text, aligned: name, default, unit, range, meaning.
std::string settings_table();
/// The same as a Markdown table.
std::string settings_markdown();
/// The same as a settings file that sets every setting to its default.
std::string settings_toml();

}  // namespace roomscribe::cli
