// SPDX-License-Identifier: MIT
#include "roomscribe/io/number_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/io/number_text.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t rows_per_block = 1U << 13U;
/// Blocks that are in memory as numbers at one time.
constexpr std::size_t blocks_per_wave = 32;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

std::string_view line_at(std::string_view text) {
    return text.substr(0, text.find('\n'));
}

bool is_blank_line(std::string_view line) {
    return std::all_of(line.begin(), line.end(), is_blank);
}

/// Walks along one line.
class RowParser {
  public:
    RowParser(std::string_view line, char separator)
        : position_(line.data()), end_(line.data() + line.size()), separator_(separator) {}

    /// False where no number of the row stands.
    bool read(double& value, bool is_first) {
        if (separator_ == ' ') {
            skip_blanks();
        } else if (!is_first) {
            skip_decoration();
            if (position_ == end_ || *position_ != separator_) return false;
            ++position_;
        }
        if (separator_ != ' ') skip_decoration();
        if (separator_ != ' ' && (position_ == end_ || *position_ == separator_)) {
            value = not_a_number;
            return true;
        }
        if (position_ != end_ && *position_ == '+') ++position_;
        const auto [next, error] = std::from_chars(position_, end_, value);
        if (error == std::errc::result_out_of_range) {
            value = 0.0;
        } else if (error != std::errc()) {
            return false;
        }
        position_ = next;
        return position_ == end_ || is_blank(*position_) || *position_ == separator_;
    }
    /// One separator at the end is no column.
    bool at_end() {
        skip_decoration();
        if (position_ != end_ && separator_ != ' ' && *position_ == separator_) ++position_;
        skip_blanks();
        return position_ == end_;
    }

  private:
    void skip_blanks() {
        while (position_ != end_ && is_blank(*position_))
            ++position_;
    }
    void skip_decoration() {
        while (position_ != end_ && is_blank(*position_) && *position_ != separator_)
            ++position_;
    }

    const char* position_;
    const char* end_;
    char separator_;
};

bool parse_line(std::string_view line, const RowFormat& format, double* row) {
    RowParser parser(line, format.separator);
    for (std::size_t i = 0; i < format.num_columns; ++i) {
        if (!parser.read(row[i], i == 0)) return false;
    }
    return parser.at_end();
}

struct ParsedBlock {
    std::vector<double> rows;
    const char* bad_line = nullptr;
};

ParsedBlock parse_block(const RowBlock& block, const RowFormat& format,
                        const std::function<void(double*)>& convert) {
    ParsedBlock parsed;
    parsed.rows.resize(block.num_rows * format.num_columns);
    double* row = parsed.rows.data();
    for (std::string_view text = block.text; !text.empty();) {
        const std::string_view line = line_at(text);
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        if (is_blank_line(line)) continue;
        if (!parse_line(line, format, row)) {
            parsed.bad_line = line.data();
            return parsed;
        }
        convert(row);
        row += format.num_columns;
    }
    return parsed;
}

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

[[noreturn]] void fail_at(const ByteReader& reader, const char* bad_line, const RowFormat& format) {
    const std::string_view whole = reader.whole_text();
    const auto place = static_cast<std::size_t>(bad_line - whole.data());
    const std::string separator = format.separator == ' ' ? "blanks"
                                  : format.separator == '\t'
                                      ? "tabs"
                                      : fmt::format("'{}'", format.separator);
    std::string_view line = line_at(whole.substr(place));
    if (line.ends_with('\r')) line.remove_suffix(1);
    reader.fail_at_line_of(place,
                           fmt::format("{} is not {} numbers parted by {}", quote_text(line),
                                       format.num_columns, separator),
                           "every line must have the columns of the first; the file may be "
                           "damaged or cut off");
}

}  // namespace

std::size_t count_rows(std::span<const RowBlock> blocks) {
    std::size_t count = 0;
    for (const RowBlock& block : blocks)
        count += block.num_rows;
    return count;
}

std::vector<RowBlock> take_row_blocks(ByteReader& reader, std::size_t max_rows) {
    std::vector<RowBlock> blocks;
    const std::string_view text = reader.remaining_text();
    std::size_t begin = 0;
    std::size_t position = 0;
    std::size_t rows = 0;
    std::size_t all_rows = 0;
    while (position < text.size() && all_rows < max_rows) {
        const std::string_view line = line_at(text.substr(position));
        position = std::min(position + line.size() + 1, text.size());
        if (!is_blank_line(line)) {
            ++rows;
            ++all_rows;
        }
        if (rows == rows_per_block) {
            blocks.push_back({text.substr(begin, position - begin), rows});
            let_go(bytes_of(blocks.back().text));
            begin = position;
            rows = 0;
        }
    }
    if (rows > 0) blocks.push_back({text.substr(begin, position - begin), rows});
    reader.skip(position);
    return blocks;
}

std::vector<double> parse_row(std::string_view line, const RowFormat& format) {
    std::vector<double> row(format.num_columns);
    if (!parse_line(line, format, row.data())) row.clear();
    return row;
}

void read_rows(
    const ByteReader& reader, std::span<const RowBlock> blocks, const RowFormat& format,
    const Context& context, const std::function<void(double* row)>& convert,
    const std::function<void(std::span<const double> rows, std::size_t num_rows)>& consume) {
    std::vector<ParsedBlock> parsed;
    for (std::size_t first = 0; first < blocks.size(); first += blocks_per_wave) {
        const auto wave = blocks.subspan(first, std::min(blocks_per_wave, blocks.size() - first));
        parsed.resize(wave.size());
        parallel_for(context, wave.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                parsed[i] = parse_block(wave[i], format, convert);
        });
        for (std::size_t i = 0; i < wave.size(); ++i) {
            if (parsed[i].bad_line != nullptr) fail_at(reader, parsed[i].bad_line, format);
            consume(parsed[i].rows, wave[i].num_rows);
            let_go(bytes_of(wave[i].text));
        }
    }
}

}  // namespace roomscribe
