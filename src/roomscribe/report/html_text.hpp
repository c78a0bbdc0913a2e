// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roomscribe {

/// Text as HTML shows it, safe between tags and inside quoted attributes. Control characters
/// become U+FFFD.
std::string escape_html(std::string_view text);

/// RFC 4648, with padding.
std::string encode_base64(std::span<const std::byte> bytes);

/// 1234567 -> "1,234,567".
std::string with_separators(std::uint64_t number);

/// A name of files for people: "base_unit" is "base unit".
std::string in_words(std::string_view name);

/// "1 scan", "2 scans".
std::string counted(std::size_t count, std::string_view one);

/// A number with a true minus sign, and none before a zero.
std::string decimal(double value, int decimals);

/// A dot and a word, coloured by what the word means: "accepted", "doubtful", "ambiguous",
/// "rejected".
std::string verdict_mark(std::string_view verdict);

struct HtmlColumn {
    std::string title;
    bool is_number = false;
};

/// A table with caption and column heads, row by row, cell by cell. The first cell of a row is its
/// head. Cells of a number column sort by their value.
class HtmlTable {
  public:
    HtmlTable(std::string_view caption, std::vector<HtmlColumn> columns);

    void begin_row(std::string_view css_class = {});
    void text(std::string_view text);
    void html(std::string_view html, std::string_view sort_by = {});
    /// The value with this many decimals; a dash if it is absent or not finite.
    void number(std::optional<double> value, int decimals);
    void count(std::uint64_t value);

    /// The whole table, or nothing if it has no rows.
    std::string finish() const;

  private:
    void cell(std::string_view attributes, std::string_view html);

    std::string head_;
    std::vector<HtmlColumn> columns_;
    std::string body_;
    std::size_t column_ = 0;
};

}  // namespace roomscribe
