// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/io/number_rows.hpp"

namespace roomscribe {

/// What the columns of a table of points hold, and how that is known.
struct GuessedColumns {
    RowFormat format;
    /// One per column, as the fields of other formats are called: x, y, z, intensity, red, green,
    /// blue, nx, ny, nz; else what the file calls it, or column_7.
    std::vector<std::string> names;
    std::string reason;         ///< in words, for people
    double color_factor = 1.0;  ///< makes the colours 0 to 255
};

/// The separator of a line: ';', ',' or a tab if one stands in it, else blanks.
char guess_separator(std::string_view line);

/// The words of a line, without quotes and blanks around them.
std::vector<std::string_view> split_line(std::string_view line, char separator);

/// Tells columns by their names in the file. Empty if x, y or z is not among them.
std::optional<std::vector<std::string>> columns_of_names(std::span<const std::string_view> words);

/// Tells columns by the numbers in the first rows: x y z, and behind them in any order colours
/// (three columns of whole numbers from 0 to 255), normals (three of length 1) and one other, the
/// intensity. Precondition: at least 3 columns, and one row.
std::vector<std::string> columns_of_numbers(std::span<const std::vector<double>> rows);

/// What the colours of these rows are to be multiplied with: 255 if all are from 0 to 1 and one is
/// not whole, 1 / 257 if one is above 255. 1 without colours.
double guess_color_factor(std::span<const std::string> names,
                          std::span<const std::vector<double>> rows);

}  // namespace roomscribe
