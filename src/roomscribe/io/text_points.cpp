// SPDX-License-Identifier: MIT
#include "roomscribe/io/text_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/guessed_columns.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/point_encoder.hpp"
#include "roomscribe/io/row_fields.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view format_name = "text";
constexpr std::string_view cure = "write x y z, and perhaps intensity and r g b, in each line";
constexpr std::size_t max_columns = 256;
/// Enough to meet a colour that is no normal, and an intensity that is no colour.
constexpr std::size_t rows_to_guess_by = 1000;
constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

bool is_blank_line(std::string_view line) {
    return line.find_first_not_of(" \t\r") == std::string_view::npos;
}

/// Skips comments and blank lines; the last comment, without its marks.
std::string_view skip_comments(ByteReader& reader) {
    std::string_view comment;
    while (!reader.at_end()) {
        ByteReader next = reader;
        const std::string_view line = next.read_line();
        if (line.starts_with('#')) {
            comment = line.substr(1);
        } else if (line.starts_with("//")) {
            comment = line.substr(2);
        } else if (!is_blank_line(line)) {
            break;
        }
        reader = next;
    }
    return comment;
}

/// Takes the line with the number of points that PTS has; true if there is one.
std::optional<std::uint64_t> take_count_line(ByteReader& reader) {
    ByteReader next = reader;
    std::vector<std::string_view> words;
    while (words.empty() && !next.at_end())
        words = split_words(next.read_line());
    if (words.size() != 1) return std::nullopt;
    const auto count = parse_count(words[0]);
    if (count) reader = next;
    return count;
}

bool is_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    return word.empty() || parse_real(word);
}

/// The first rows, for guessing; `reader` is a copy.
std::vector<std::vector<double>> first_rows(ByteReader reader, const RowFormat& format) {
    std::vector<std::vector<double>> rows;
    while (!reader.at_end() && rows.size() < rows_to_guess_by) {
        const std::string_view line = reader.read_line();
        if (is_blank_line(line)) continue;
        std::vector<double> row = parse_row(line, format);
        if (row.empty()) break;
        rows.push_back(std::move(row));
    }
    return rows;
}

/// Takes a header line, if there is one. `comment` may name the columns, too.
GuessedColumns guess_columns(ByteReader& reader, std::string_view comment) {
    if (reader.at_end()) reader.fail_at_byte("there is no point in it", cure);
    ByteReader next = reader;
    const std::string_view line = next.read_line();
    GuessedColumns guess;
    guess.format.separator = guess_separator(line);
    const auto words = split_line(line, guess.format.separator);
    guess.format.num_columns = words.size();
    if (words.size() < 3 || words.size() > max_columns) {
        next.fail_at_line(fmt::format("{} columns are no point", words.size()), cure);
    }
    std::optional<std::vector<std::string>> names;
    if (std::all_of(words.begin(), words.end(), is_number)) {
        const auto comment_words = split_line(comment, guess_separator(comment));
        if (comment_words.size() == words.size()) names = columns_of_names(comment_words);
    } else {
        names = columns_of_names(words);
        if (!names) {
            next.fail_at_line(
                fmt::format("{} are neither numbers nor names with x, y and z", quote_text(line)),
                cure);
        }
        reader = next;
    }
    const auto rows = first_rows(reader, guess.format);
    if (names) {
        guess.names = std::move(*names);
        guess.reason = "by the names in the file";
    } else if (rows.empty()) {
        next.fail_at_line(fmt::format("{} is not {} numbers", quote_text(line), words.size()),
                          cure);
    } else {
        guess.names = columns_of_numbers(rows);
        guess.reason = "by their numbers";
    }
    guess.color_factor = guess_color_factor(guess.names, rows);
    return guess;
}

std::string describe(const GuessedColumns& guess) {
    const char separator = guess.format.separator;
    std::string text =
        fmt::format("columns, told {}: {}; parted by {}", guess.reason, fmt::join(guess.names, " "),
                    separator == ' '    ? std::string("blanks")
                    : separator == '\t' ? std::string("tabs")
                                        : fmt::format("'{}'", separator));
    if (guess.color_factor > 1.0) text += "; colours from 0 to 1";
    if (guess.color_factor < 1.0) text += "; colours of 16 bits";
    return text;
}

/// All rows of the file. Parts of PTS have their counts between them.
std::vector<RowBlock> take_all_rows(ByteReader& reader, std::optional<std::uint64_t> count) {
    if (!count) return take_row_blocks(reader, no_limit);
    std::vector<RowBlock> all;
    while (count) {
        reader.require_backed(*count, 5, "points");
        const std::vector<RowBlock> part = take_row_blocks(reader, *count);
        const std::size_t num_rows = count_rows(part);
        if (num_rows < *count) {
            reader.fail_at_byte(fmt::format("there are {} of {} points", num_rows, *count),
                                "the file is cut off: copy it again");
        }
        all.insert(all.end(), part.begin(), part.end());
        count = take_count_line(reader);
    }
    if (reader.remaining_text().find_first_not_of(" \t\r\n") != std::string_view::npos) {
        reader.fail_at_line_of(reader.position(), "there are more lines than the count says",
                               "repair the count before the points");
    }
    return all;
}

}  // namespace

FileContents read_text_points(const std::filesystem::path& path, PointsAs as,
                              const Context& context) {
    const MappedFile file(path, format_name);
    ByteReader reader(file, format_name);
    const std::string_view comment = skip_comments(reader);
    const std::optional<std::uint64_t> count = take_count_line(reader);
    if (count) skip_comments(reader);
    const GuessedColumns guess = guess_columns(reader, comment);
    const std::vector<RowBlock> blocks = take_all_rows(reader, count);

    FileContents contents;
    contents.format = count ? "PTS" : "text";
    contents.encoding = "ascii";
    contents.fields = row_fields(guess.names);
    contents.warnings.push_back(describe(guess));
    context.report_message(path.filename().string() + ": " + contents.warnings.front());
    decode_rows(reader, blocks, guess.format, guess.color_factor, false, as, contents, context);
    return contents;
}

void write_text_points(const std::filesystem::path& path, const PointCloud& cloud,
                       const Context& context) {
    const PointColumns points(cloud, FieldStyle::ply);
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const char separator = extension == ".csv" ? ',' : ' ';
    std::vector<std::string_view> names;
    for (const FieldColumn& column : points.columns())
        names.emplace_back(column.field.name);
    AtomicFile file(path, format_name);
    file.write(fmt::format("{}{}\n", separator == ',' ? "" : "# ",
                           fmt::join(names, std::string(1, separator))));
    write_text(file, points, context, separator);
    file.commit();
}

}  // namespace roomscribe
