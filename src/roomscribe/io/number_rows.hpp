// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe {

/// How the numbers of a line are parted: by ' ' (any blanks), ',', ';' or a tab. Beside all but ' '
/// blanks are mere decoration, and nothing between two separators is NaN.
struct RowFormat {
    char separator = ' ';
    std::size_t num_columns = 3;
};

/// Consecutive lines of a text.
struct RowBlock {
    std::string_view text;
    std::size_t num_rows = 0;  ///< lines that are not blank
};

std::size_t count_rows(std::span<const RowBlock> blocks);

/// Cuts the text that `reader` has left into blocks, up to `max_rows` rows, and moves the reader
/// behind them.
std::vector<RowBlock> take_row_blocks(ByteReader& reader, std::size_t max_rows);

/// The numbers of one line; empty unless they are exactly `format.num_columns`.
std::vector<double> parse_row(std::string_view line, const RowFormat& format);

/// Reads lines of numbers on all threads: `convert` changes a row in place and may be called from
/// any of them; `consume` takes rows, one behind another, in the order of the file, from the
/// calling thread. Throws IoError that names the line which does not fit.
void read_rows(
    const ByteReader& reader, std::span<const RowBlock> blocks, const RowFormat& format,
    const Context& context, const std::function<void(double* row)>& convert,
    const std::function<void(std::span<const double> rows, std::size_t num_rows)>& consume);

}  // namespace roomscribe
