// SPDX-License-Identifier: MIT
#include "roomscribe/io/row_fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace roomscribe {
namespace {

bool is_color(const std::string& name) {
    return name == "red" || name == "green" || name == "blue";
}

}  // namespace

std::uint8_t color_byte(double value) {
    // The comparison is false for NaN, too.
    if (!(value > 0.0)) return 0;
    return static_cast<std::uint8_t>(std::min(std::round(value), 255.0));
}

std::vector<Field> row_fields(std::span<const std::string> names) {
    const bool colored = std::count_if(names.begin(), names.end(), is_color) == 3;
    std::vector<Field> fields;
    for (const std::string& name : names) {
        const bool byte = colored && is_color(name);
        fields.push_back({name, byte ? ScalarType::uint8 : ScalarType::float64, 1});
    }
    return fields;
}

void decode_rows(const ByteReader& reader, std::span<const RowBlock> blocks,
                 const RowFormat& format, double color_factor, bool zero_is_missing, PointsAs as,
                 FileContents& contents, const Context& context) {
    const std::span<const Field> fields = contents.fields;
    PointDecoder decoder(fields, count_rows(blocks), as);

    std::vector<std::size_t> colors;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (fields[i].type == ScalarType::uint8) colors.push_back(i);
    }
    // A colour stands in the first byte of its column.
    const auto convert = [&](double* row) {
        for (const std::size_t column : colors) {
            const std::uint8_t byte = color_byte(row[column] * color_factor);
            std::memcpy(row + column, &byte, sizeof(byte));
        }
        if (zero_is_missing && row[0] == 0.0 && row[1] == 0.0 && row[2] == 0.0) {
            std::fill_n(row, 3, std::numeric_limits<double>::quiet_NaN());
        }
    };
    std::size_t first = 0;
    Context one_thread = context;
    one_thread.num_threads = 1;  // a block is too small to share
    const auto consume = [&](std::span<const double> rows, std::size_t count) {
        std::vector<FieldSource> sources;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            sources.push_back({reinterpret_cast<const std::byte*>(rows.data() + i),
                               format.num_columns * sizeof(double)});
        }
        decoder.decode(sources, first, count, std::endian::native, one_thread);
        first += count;
    };
    read_rows(reader, blocks, format, context, convert, consume);
    decoder.finish(contents, std::nullopt, std::nullopt);
}

}  // namespace roomscribe
