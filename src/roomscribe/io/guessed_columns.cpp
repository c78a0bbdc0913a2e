// SPDX-License-Identifier: MIT
#include "roomscribe/io/guessed_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace roomscribe {
namespace {

using Rows = std::span<const std::vector<double>>;

/// Unit vectors that were written with two digits or more: each may be off by 0.005.
constexpr double normal_tolerance = 0.01;

const std::map<std::string_view, std::string_view>& known_names() {
    static const std::map<std::string_view, std::string_view> names = {
        {"x", "x"},
        {"y", "y"},
        {"z", "z"},
        {"r", "red"},
        {"g", "green"},
        {"b", "blue"},
        {"red", "red"},
        {"green", "green"},
        {"blue", "blue"},
        {"i", "intensity"},
        {"intensity", "intensity"},
        {"reflectance", "intensity"},
        {"reflectivity", "intensity"},
        {"scalar_intensity", "intensity"},
        {"nx", "nx"},
        {"ny", "ny"},
        {"nz", "nz"},
        {"normal_x", "nx"},
        {"normal_y", "ny"},
        {"normal_z", "nz"}};
    return names;
}

std::string trimmed_name(std::string_view word) {
    std::string name;
    for (const char c : word) {
        const bool plain = c > ' ' && c <= '~';
        name += plain ? c : '_';
    }
    return name;
}

bool all_of_columns(Rows rows, std::size_t column, std::size_t count, bool (*holds)(double)) {
    return std::all_of(rows.begin(), rows.end(), [&](const std::vector<double>& row) {
        return std::all_of(row.begin() + static_cast<std::ptrdiff_t>(column),
                           row.begin() + static_cast<std::ptrdiff_t>(column + count), holds);
    });
}

bool look_like_colors(Rows rows, std::size_t column) {
    return all_of_columns(rows, column, 3, [](double value) {
        return value >= 0.0 && value <= 255.0 && value == std::floor(value);
    });
}

bool look_like_normals(Rows rows, std::size_t column) {
    // Black pixels are whole numbers, too, but not of length 1.
    return std::all_of(rows.begin(), rows.end(), [&](const std::vector<double>& row) {
        const double length = std::hypot(row[column], row[column + 1], row[column + 2]);
        return std::abs(length - 1.0) < normal_tolerance || std::isnan(length);
    });
}

bool look_like_unit_colors(Rows rows, std::size_t column) {
    return all_of_columns(rows, column, 3,
                          [](double value) { return value >= 0.0 && value <= 1.0; });
}

void add_names(std::vector<std::string>& names, const std::array<const char*, 3>& more) {
    names.insert(names.end(), more.begin(), more.end());
}

}  // namespace

char guess_separator(std::string_view line) {
    for (const char separator : {';', ',', '\t'}) {
        if (line.find(separator) != std::string_view::npos) return separator;
    }
    return ' ';
}

std::vector<std::string_view> split_line(std::string_view line, char separator) {
    constexpr std::string_view around = " \t\r\"";
    std::vector<std::string_view> words;
    for (std::size_t position = 0; position <= line.size();) {
        std::size_t end = line.find(separator, position);
        if (separator == ' ') end = line.find_first_of(" \t\r", position);
        end = std::min(end, line.size());
        std::string_view word = line.substr(position, end - position);
        word.remove_prefix(std::min(word.find_first_not_of(around), word.size()));
        word = word.substr(0, word.find_last_not_of(around) + 1);
        const bool is_last = end == line.size();
        if (!word.empty() || (separator != ' ' && !is_last)) words.push_back(word);
        position = end + 1;
    }
    return words;
}

std::optional<std::vector<std::string>> columns_of_names(std::span<const std::string_view> words) {
    std::vector<std::string> names;
    for (const std::string_view word : words) {
        std::string lower = trimmed_name(word);
        for (char& c : lower)
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        // A unit or an index in brackets is no part of the name.
        const std::string bare = lower.substr(0, lower.find_first_of("[("));
        const auto known = known_names().find(bare);
        std::string name(known == known_names().end() ? trimmed_name(word) : known->second);
        if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) {
            name = fmt::format("column_{}", names.size() + 1);
        }
        names.push_back(std::move(name));
    }
    for (const char* axis : {"x", "y", "z"}) {
        if (std::find(names.begin(), names.end(), axis) == names.end()) return std::nullopt;
    }
    return names;
}

std::vector<std::string> columns_of_numbers(Rows rows) {
    const std::size_t num_columns = rows.front().size();
    std::vector<std::string> names = {"x", "y", "z"};
    const auto has = [&](const char* name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    while (names.size() < num_columns) {
        const std::size_t column = names.size();
        const std::size_t left = num_columns - column;
        // A whole intensity before the colours makes a triple with two of them.
        const bool one_more =
            (left == 4 || left == 7) && !has("intensity") &&
            (look_like_colors(rows, column + 1) || look_like_unit_colors(rows, column + 1));
        if (left >= 3 && !has("nx") && look_like_normals(rows, column)) {
            add_names(names, {"nx", "ny", "nz"});
        } else if (left >= 3 && !one_more && !has("red") &&
                   (look_like_colors(rows, column) || look_like_unit_colors(rows, column))) {
            add_names(names, {"red", "green", "blue"});
        } else if (!has("intensity")) {
            names.emplace_back("intensity");
        } else {
            names.push_back(fmt::format("column_{}", column + 1));
        }
    }
    return names;
}

double guess_color_factor(std::span<const std::string> names, Rows rows) {
    double highest = 0.0;
    bool whole = true;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] != "red" && names[i] != "green" && names[i] != "blue") continue;
        for (const std::vector<double>& row : rows) {
            highest = std::max(highest, row[i]);
            whole = whole && row[i] == std::floor(row[i]);
        }
    }
    if (highest <= 1.0 && !whole) return 255.0;
    return highest > 255.0 ? 1.0 / 257.0 : 1.0;
}

}  // namespace roomscribe
