// SPDX-License-Identifier: MIT
#include "roomscribe/io/npy.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/guessed_columns.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/row_fields.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view format_name = "NPY";
constexpr std::string_view magic = "\x93NUMPY";
constexpr std::string_view cure = "save a one-dimensional array with numpy.save";

template <typename Value>
constexpr std::string_view type_code() {
    if constexpr (std::is_same_v<Value, std::uint8_t>) return "|u1";
    if constexpr (std::is_same_v<Value, std::uint16_t>) return "<u2";
    if constexpr (std::is_same_v<Value, std::int32_t>) return "<i4";
}

/// What stands after 'key': in the header, which is a dictionary in Python's notation, without
/// leading blanks; empty if the key is absent.
std::string_view after_key(std::string_view header, std::string_view key) {
    for (const char quote : {'\'', '"'}) {
        const std::size_t found = header.find(fmt::format("{0}{1}{0}", quote, key));
        if (found == std::string_view::npos) continue;
        std::string_view rest = header.substr(found + key.size() + 2);
        const std::size_t value = rest.find_first_not_of(" \t:");
        return value == std::string_view::npos ? std::string_view() : rest.substr(value);
    }
    return {};
}

/// The word in quotes with which the text begins.
std::optional<std::string_view> quoted_word(std::string_view text) {
    if (text.empty() || (text[0] != '\'' && text[0] != '"')) return std::nullopt;
    const std::size_t end = text.find(text[0], 1);
    if (end == std::string_view::npos) return std::nullopt;
    return text.substr(1, end - 1);
}

/// 3 for "(3,)"; empty for any other number of dimensions.
std::optional<std::uint64_t> only_dimension(std::string_view text) {
    const std::size_t end = text.find(')');
    if (!text.starts_with('(') || end == std::string_view::npos) return std::nullopt;
    std::string_view inside = text.substr(1, end - 1);
    const std::size_t comma = inside.find(',');
    if (comma == std::string_view::npos ||
        inside.find_first_not_of(" \t", comma + 1) != std::string_view::npos) {
        return std::nullopt;
    }
    const std::vector<std::string_view> words = split_words(inside.substr(0, comma));
    return words.size() == 1 ? parse_count(words[0]) : std::nullopt;
}

/// The two numbers of "(5, 3)"; empty for any other number of dimensions.
std::optional<std::array<std::uint64_t, 2>> two_dimensions(std::string_view text) {
    const std::size_t end = text.find(')');
    if (!text.starts_with('(') || end == std::string_view::npos) return std::nullopt;
    const std::string_view inside = text.substr(1, end - 1);
    const std::size_t comma = inside.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const auto rows = split_words(inside.substr(0, comma));
    const auto columns = split_words(inside.substr(comma + 1));
    if (rows.size() != 1 || columns.size() != 1) return std::nullopt;
    const auto num_rows = parse_count(rows[0]);
    const auto num_columns = parse_count(columns[0]);
    if (!num_rows || !num_columns) return std::nullopt;
    return std::array<std::uint64_t, 2>{*num_rows, *num_columns};
}

std::string_view read_header(ByteReader& reader) {
    const auto text_of = [](std::span<const std::byte> bytes) {
        return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    if (!reader.remaining_text().starts_with(magic)) {
        reader.fail_at_byte("it does not begin as an NPY file does", cure);
    }
    reader.skip(magic.size());
    const auto version = reader.read<std::uint8_t>();
    reader.read<std::uint8_t>();  // minor
    if (version != 1 && version != 2) {
        reader.fail_at_byte(fmt::format("NPY format {} is not read, only 1 and 2", version), cure);
    }
    const std::size_t length =
        version == 1 ? reader.read<std::uint16_t>() : reader.read<std::uint32_t>();
    return text_of(reader.take(length));
}

}  // namespace

template <typename Value>
std::vector<Value> read_npy(const std::filesystem::path& path) {
    const MappedFile file(path, format_name);
    ByteReader reader(file, format_name);
    const std::string_view header = read_header(reader);

    const std::optional<std::string_view> type = quoted_word(after_key(header, "descr"));
    if (!type) reader.fail_at_byte("the header names no element type", cure);
    if (*type != type_code<Value>()) {
        reader.fail_at_byte(fmt::format("the elements are {} instead of '{}'", quote_text(*type),
                                        type_code<Value>()),
                            "convert the array with numpy's astype, and save it again");
    }
    const std::optional<std::uint64_t> size = only_dimension(after_key(header, "shape"));
    if (!size) reader.fail_at_byte("the array has not exactly one dimension", cure);
    reader.require_backed(*size, sizeof(Value), "elements");

    std::vector<Value> values(static_cast<std::size_t>(*size));
    for (Value& value : values)
        value = reader.read<Value>();
    return values;
}

FileContents read_npy_points(const std::filesystem::path& path, PointsAs as,
                             const Context& context) {
    constexpr std::string_view points_cure =
        "save an array of N x 3 to 6 float32 or float64 with numpy.save";
    constexpr std::size_t rows_to_guess_by = 1000;
    const MappedFile file(path, format_name);
    ByteReader reader(file, format_name);
    const std::string_view header = read_header(reader);
    const std::string_view code = quoted_word(after_key(header, "descr")).value_or("");
    if (code != "<f4" && code != "<f8") {
        reader.fail_at_byte(fmt::format("the elements are {}", quote_text(code)), points_cure);
    }
    const ScalarType type = code == "<f4" ? ScalarType::float32 : ScalarType::float64;
    const auto shape = two_dimensions(after_key(header, "shape"));
    if (!shape || (*shape)[1] < 3 || (*shape)[1] > 6) {
        reader.fail_at_byte("the array has not two dimensions, the second of 3 to 6", points_cure);
    }
    const auto [num_rows, num_columns] = *shape;
    const std::size_t size = size_of(type);
    reader.require_backed_at_byte(num_rows, num_columns * size, "points");
    const std::byte* const first = reader.take(num_rows * num_columns * size).data();
    const bool by_column = after_key(header, "fortran_order").starts_with("True");
    std::vector<FieldSource> sources;
    for (std::size_t k = 0; k < num_columns; ++k) {
        sources.push_back(by_column ? FieldSource{first + k * num_rows * size, size}
                                    : FieldSource{first + k * size, num_columns * size});
    }

    const bool swap = std::endian::native == std::endian::big;
    const auto value_at = [&](std::size_t row, std::size_t column) {
        return load_as_double(sources[column].first + row * sources[column].stride, type, swap);
    };
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < std::min<std::size_t>(num_rows, rows_to_guess_by); ++i) {
        std::vector<double>& row = rows.emplace_back();
        for (std::size_t k = 0; k < num_columns; ++k)
            row.push_back(value_at(i, k));
    }
    if (rows.empty()) rows.emplace_back(num_columns, 0.0);
    const std::vector<std::string> names = columns_of_numbers(rows);
    const double color_factor = guess_color_factor(names, rows);

    FileContents contents;
    contents.format = format_name;
    contents.encoding = code;
    std::vector<Field> decoded;
    std::vector<std::size_t> colors;
    for (std::size_t k = 0; k < num_columns; ++k) {
        contents.fields.push_back({names[k], type, 1});
        const bool color = names[k] == "red" || names[k] == "green" || names[k] == "blue";
        if (color) colors.push_back(k);
        decoded.push_back({color ? "_" : names[k], type, 1});
    }
    contents.warnings.push_back(
        fmt::format("columns, told by their numbers: {}", fmt::join(names, " ")));
    context.report_message(path.filename().string() + ": " + contents.warnings.front());
    PointDecoder decoder(decoded, num_rows, as);
    constexpr std::size_t rows_per_run = 1U << 19U;
    for (std::size_t row = 0; row < num_rows; row += rows_per_run) {
        const std::size_t count = std::min<std::size_t>(rows_per_run, num_rows - row);
        std::vector<FieldSource> run = sources;
        for (FieldSource& source : run)
            source.first += row * source.stride;
        decoder.decode(run, row, count, std::endian::little, context);
        for (const FieldSource& source : run)
            let_go({source.first, count * source.stride});
    }
    decoder.finish(contents, std::nullopt, std::nullopt);
    for (std::size_t i = 0; i < contents.cloud.size() && !colors.empty(); ++i) {
        auto& color = contents.cloud.colors.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            color[k] = color_byte(value_at(i, colors[k]) * color_factor);
    }
    return contents;
}

template <typename Value>
void write_npy(const std::filesystem::path& path, std::span<const Value> values) {
    static_assert(std::endian::native == std::endian::little);
    // The header is padded with blanks so that the elements begin at a multiple of 64 bytes.
    std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({},), }}",
                                     type_code<Value>(), values.size());
    const std::size_t preamble = magic.size() + 4;
    header.append(63 - (preamble + header.size()) % 64, ' ');
    header += '\n';

    AtomicFile file(path, format_name);
    file.write(magic);
    const auto length = static_cast<std::uint16_t>(header.size());
    file.write(std::string{'\x01', '\x00', static_cast<char>(length & 0xFFU),
                           static_cast<char>(length >> 8U)});
    file.write(header);
    file.write(std::as_bytes(values));
    file.commit();
}

template std::vector<std::uint8_t> read_npy(const std::filesystem::path&);
template std::vector<std::uint16_t> read_npy(const std::filesystem::path&);
template std::vector<std::int32_t> read_npy(const std::filesystem::path&);
template void write_npy(const std::filesystem::path&, std::span<const std::uint8_t>);
template void write_npy(const std::filesystem::path&, std::span<const std::uint16_t>);
template void write_npy(const std::filesystem::path&, std::span<const std::int32_t>);

}  // namespace roomscribe
