// SPDX-License-Identifier: MIT
#include "roomscribe/io/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "roomscribe/io/scalar_dispatch.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk_bytes = 1U << 18U;
constexpr std::string_view cure = "the file is damaged or cut off: write or copy it again";

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// The number at `first`, with an optional plus sign; null if there is none of that type.
template <typename Value>
const char* parse_at(const char* first, const char* last, Value& value) {
    if (first != last && *first == '+') ++first;
    const auto [end, error] = std::from_chars(first, last, value);
    if constexpr (std::is_same_v<Value, float>) {
        // Too small or too large for float32: what double holds is rounded to 0 or infinity.
        double wide = 0.0;
        if (error == std::errc::result_out_of_range) {
            const auto [wide_end, wide_error] = std::from_chars(first, last, wide);
            value = std::abs(wide) < 1.0 ? 0.0F : std::numeric_limits<float>::infinity();
            value = std::copysign(value, wide < 0.0 ? -1.0F : 1.0F);
            return wide_error == std::errc() ? wide_end : nullptr;
        }
    }
    return error == std::errc() ? end : nullptr;
}

template <typename Value>
std::optional<Value> parse_word(std::string_view word) {
    Value value{};
    const char* const last = word.data() + word.size();
    if (parse_at(word.data(), last, value) != last || word.empty()) return std::nullopt;
    return value;
}

bool ends_word(const char* position, const char* end) {
    return position == end || is_blank(*position) || *position == '\n';
}

/// An integer that another program wrote as "7.0" or "7e0".
template <typename Value>
const char* parse_integral_real(const char* first, const char* last, Value& value) {
    double real = 0.0;
    const char* const end = parse_at(first, last, real);
    constexpr auto low = static_cast<double>(std::numeric_limits<Value>::min());
    constexpr auto high = static_cast<double>(std::numeric_limits<Value>::max());
    if (end == nullptr || !(real >= low && real < high) || real != std::floor(real)) return nullptr;
    value = static_cast<Value>(real);
    return end;
}

}  // namespace

std::vector<std::string_view> split_words(std::string_view line) {
    std::vector<std::string_view> words;
    std::size_t position = 0;
    while (true) {
        position = line.find_first_not_of(" \t\r", position);
        if (position == std::string_view::npos) return words;
        const std::size_t end = std::min(line.find_first_of(" \t\r", position), line.size());
        words.push_back(line.substr(position, end - position));
        position = end;
    }
}

std::optional<std::uint64_t> parse_count(std::string_view word) {
    return parse_word<std::uint64_t>(word);
}

std::optional<double> parse_real(std::string_view word) {
    return parse_word<double>(word);
}

std::string quote_text(std::string_view text) {
    std::string result(text.substr(0, 40));
    for (char& c : result) {
        if (c < ' ' || c > '~') c = '?';
    }
    return fmt::format("'{}{}'", result, text.size() > 40 ? "..." : "");
}

void append_number(std::string& text, ScalarType type, const std::byte* bytes) {
    with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
        Value value;
        std::memcpy(&value, bytes, sizeof(Value));
        if constexpr (std::is_floating_point_v<Value>) {
            if (std::isnan(value)) {
                text += "nan";
                return;
            }
        }
        char digits[32];
        const auto result = std::to_chars(digits, digits + sizeof(digits), value);
        text.append(digits, result.ptr);
    });
}

TextTable::TextTable(ByteReader& reader, std::span<const TextColumn> columns, bool free_form)
    : reader_(reader), columns_(columns), free_form_(free_form) {
    for (const TextColumn& column : columns) {
        if (!column.is_list) row_bytes_ += size_of(column.type);
    }
    const std::string_view text = reader.remaining_text();
    begin_ = position_ = held_ = text.data();
    end_ = begin_ + text.size();
}

void TextTable::skip_space() {
    while (position_ != end_ && (is_blank(*position_) || (free_form_ && *position_ == '\n'))) {
        ++position_;
    }
}

void TextTable::skip_blank_lines() {
    while (position_ != end_ && (is_blank(*position_) || *position_ == '\n'))
        ++position_;
}

void TextTable::read_row(std::byte* values) {
    const auto passed = static_cast<std::size_t>(position_ - held_);
    if (passed >= bytes_let_go_at_once) {
        let_go(std::as_bytes(std::span(held_, passed)));
        held_ = position_;
    }
    skip_blank_lines();
    for (const TextColumn& column : columns_) {
        if (column.is_list) {
            std::uint64_t size = 0;
            read_value(ScalarType::uint64, reinterpret_cast<std::byte*>(&size));
            double skipped = 0.0;
            for (std::uint64_t i = 0; i < size; ++i) {
                read_value(ScalarType::float64, reinterpret_cast<std::byte*>(&skipped));
            }
        } else {
            read_value(column.type, values);
            values += size_of(column.type);
        }
    }
    if (!free_form_) end_line();
}

void TextTable::finish() {
    reader_.skip(static_cast<std::size_t>(position_ - begin_));
}

void TextTable::read_value(ScalarType type, std::byte* bytes) {
    skip_space();
    with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
        Value value{};
        const char* next = parse_at(position_, end_, value);
        if constexpr (std::is_integral_v<Value>) {
            if (next == nullptr || !ends_word(next, end_)) {
                next = parse_integral_real(position_, end_, value);
            }
        }
        if (next == nullptr || !ends_word(next, end_)) {
            if (position_ == end_) fail("the file ends before its last value");
            if (*position_ == '\n') fail("the line has too few values");
            const char* const word_end =
                std::find_if(position_, end_, [](char c) { return is_blank(c) || c == '\n'; });
            const std::string_view word(position_, static_cast<std::size_t>(word_end - position_));
            fail(fmt::format("{} is no {} value", quote_text(word), scalar_type_name(type)));
        }
        std::memcpy(bytes, &value, sizeof(Value));
        position_ = next;
    });
}

void TextTable::end_line() {
    skip_space();
    if (position_ == end_) return;
    if (*position_ != '\n') fail("the line has too many values");
    ++position_;
}

void TextTable::fail(std::string_view reason) const {
    const auto read = static_cast<std::size_t>(position_ - begin_);
    reader_.fail_at_line_of(reader_.position() + read, reason, cure);
}

void decode_text(ByteReader& reader, std::span<const Field> fields, std::size_t num_points,
                 bool free_form, PointDecoder& decoder, const Context& context) {
    if (num_points == 0) return;
    std::vector<TextColumn> columns;
    for (const Field& field : fields)
        columns.insert(columns.end(), field.count, {field.type});
    TextTable table(reader, columns, free_form);
    const std::size_t rows =
        std::clamp<std::size_t>(chunk_bytes / table.row_bytes(), 1, num_points);
    std::vector<std::byte> records(rows * table.row_bytes());
    const std::vector<FieldSource> sources = record_sources(fields, records.data());
    for (std::size_t first = 0; first < num_points; first += rows) {
        context.throw_if_cancelled();
        const std::size_t count = std::min(rows, num_points - first);
        for (std::size_t i = 0; i < count; ++i) {
            table.read_row(records.data() + i * table.row_bytes());
        }
        decoder.decode(sources, first, count, std::endian::native, context);
    }
    table.finish();
}

}  // namespace roomscribe
