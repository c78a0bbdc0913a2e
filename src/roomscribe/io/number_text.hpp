// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

/// The words of a line, parted by spaces and tabs.
std::vector<std::string_view> split_words(std::string_view line);

/// A whole word as a number that is not negative, or as any number; empty if it is none.
std::optional<std::uint64_t> parse_count(std::string_view word);
std::optional<double> parse_real(std::string_view word);

/// Foreign text fit for a one-line message: in quotes, short, unprintable bytes as '?'.
std::string quote_text(std::string_view text);

/// Appends the shortest text that reads back as the same number; NaN is "nan".
void append_number(std::string& text, ScalarType type, const std::byte* value);

/// One column of a table of numbers in a text. A list is a count and as many values; it is skipped.
struct TextColumn {
    ScalarType type = ScalarType::float32;
    bool is_list = false;
};

/// Reads the rows of a table of numbers, which stand in the text that `reader` has left.
/// Everything that does not fit throws IoError with its line.
class TextTable {
  public:
    /// `free_form`: line ends are mere space, as in VTK. Else each row is one line, and empty lines
    /// between rows are skipped.
    TextTable(ByteReader& reader, std::span<const TextColumn> columns, bool free_form = false);
    /// Bytes of one row, with the values of the columns that are no lists one behind another.
    std::size_t row_bytes() const { return row_bytes_; }
    /// Reads the next row into `values`, in native byte order.
    void read_row(std::byte* values);
    /// Moves the reader behind the rows that were read.
    void finish();

  private:
    void skip_space();
    void skip_blank_lines();
    void read_value(ScalarType type, std::byte* value);
    void end_line();
    [[noreturn]] void fail(std::string_view reason) const;

    ByteReader& reader_;
    std::span<const TextColumn> columns_;
    bool free_form_;
    std::size_t row_bytes_ = 0;
    const char* begin_;
    const char* position_;
    const char* held_;  ///< what lies before was let go
    const char* end_;
};

/// Reads `num_points` rows with the values of `fields` and gives them to the decoder.
void decode_text(ByteReader& reader, std::span<const Field> fields, std::size_t num_points,
                 bool free_form, PointDecoder& decoder, const Context& context);

}  // namespace roomscribe
