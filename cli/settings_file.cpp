// SPDX-License-Identifier: MIT
#include "cli/settings_file.hpp"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cli/command.hpp"
#include "roomscribe/core/error.hpp"

namespace roomscribe::cli {
namespace {

std::string_view trim(std::string_view text) {
    constexpr std::string_view blank = " \t\r";
    const std::size_t first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string_view without_quotes(std::string_view text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
}

void apply_line(PipelineSettings& settings, std::string_view line, std::string& group) {
    if (line.front() == '[') {
        if (line.back() != ']') throw UsageError("a group must read [name]");
        const std::string_view name = trim(line.substr(1, line.size() - 2));
        group = name.empty() ? "" : std::string(name) + ".";
        return;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) throw UsageError("a setting must read name = value");
    set_setting(settings, group + std::string(trim(line.substr(0, equals))),
                without_quotes(trim(line.substr(equals + 1))));
}

std::string range_and_unit(const SettingEntry& entry) {
    return entry.unit.empty() ? entry.range : entry.range + " " + entry.unit;
}

/// A bar would end the cell.
std::string markdown_cell(std::string_view text) {
    std::string cell;
    for (const char c : text) {
        if (c == '|') cell += '\\';
        cell += c;
    }
    return cell;
}

/// The group of "registration.icp.max_iterations" is "registration.icp".
std::string_view group_of(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
}

}  // namespace

const char* const settings_file_help =
    "A settings file has lines `name = value`, `[group]` before names that share it, and\n"
    "`# comment`; `roomscribe settings --toml` prints one with every default.\n"
    "--set goes over --config, and --seed over both.";

void apply_settings_file(PipelineSettings& settings, const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::string group;
    for (int number = 1; std::getline(file, line); ++number) {
        const std::string_view text = trim(std::string_view(line).substr(0, line.find('#')));
        if (text.empty()) continue;
        try {
            apply_line(settings, text, group);
        } catch (const std::exception& error) {
            throw UsageError(fmt::format("{}, line {}: {}", path, number, error.what()));
        }
    }
    if (!file.eof()) {
        throw IoError(path, "settings file", {}, "cannot be read",
                      "check the path and its permissions");
    }
}

void apply_assignment(PipelineSettings& settings, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
        throw UsageError(fmt::format("--set {}: must read --set name=value", assignment));
    }
    const std::string_view text = assignment;
    set_setting(settings, trim(text.substr(0, equals)), trim(text.substr(equals + 1)));
}

std::string settings_table() {
    const std::vector<SettingEntry> entries = list_settings(PipelineSettings());
    std::size_t width = 0;
    for (const SettingEntry& entry : entries)
        width = std::max(width, entry.name.size());
    std::string text;
    for (const SettingEntry& entry : entries) {
        text += fmt::format("  {:<{}}  {}  ({})\n      {}\n", entry.name, width, entry.value,
                            range_and_unit(entry), entry.doc);
    }
    return text;
}

std::string settings_markdown() {
    std::string text = "| setting | default | range | unit | meaning |\n|---|---|---|---|---|\n";
    for (const SettingEntry& entry : list_settings(PipelineSettings())) {
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", entry.name, entry.value,
                            markdown_cell(entry.range), entry.unit, markdown_cell(entry.doc));
    }
    return text;
}

std::string settings_toml() {
    std::string text;
    std::string_view group;
    const std::vector<SettingEntry> entries = list_settings(PipelineSettings());
    for (const SettingEntry& entry : entries) {
        if (group_of(entry.name) != group) {
            group = group_of(entry.name);
            text += fmt::format("\n[{}]\n", group);
        }
        const std::string_view name =
            std::string_view(entry.name).substr(group.empty() ? 0 : group.size() + 1);
        const std::string value = entry.is_text ? fmt::format("\"{}\"", entry.value) : entry.value;
        text += fmt::format("# {} ({})\n{} = {}\n", entry.doc, range_and_unit(entry), name, value);
    }
    return text;
}

}  // namespace roomscribe::cli
