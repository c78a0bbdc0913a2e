// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/pcd.hpp"
#include "roomscribe/io/point_decoder.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view header_cure = "repair the header, or write the file again";
constexpr std::uint64_t max_count = std::numeric_limits<std::uint32_t>::max();
/// LZF's longest back reference: 3 bytes stand for 264.
constexpr std::uint64_t max_lzf_ratio = 88;

using Words = std::span<const std::string_view>;

struct Header {
    std::vector<std::string> names;
    std::vector<std::uint64_t> sizes;
    std::string types;
    std::vector<std::uint64_t> counts;
    std::optional<std::uint64_t> width;
    std::optional<std::uint64_t> height;
    std::optional<std::uint64_t> num_points;
    std::optional<Transform> viewpoint;
    std::string encoding;
};

std::uint64_t read_count(const ByteReader& reader, std::string_view key, std::string_view word,
                         std::uint64_t min) {
    const std::optional<std::uint64_t> count = parse_count(word);
    if (!count || *count < min || *count > max_count) {
        reader.fail_at_line(fmt::format("{} {} is not a number from {} to {}", key,
                                        quote_text(word), min, max_count),
                            header_cure);
    }
    return *count;
}

std::vector<std::uint64_t> read_counts(const ByteReader& reader, std::string_view key,
                                       Words words) {
    std::vector<std::uint64_t> counts;
    for (const std::string_view word : words)
        counts.push_back(read_count(reader, key, word, 1));
    return counts;
}

/// tx ty tz qw qx qy qz; the default, which writers put when they know nothing, gives no pose.
std::optional<Transform> read_viewpoint(const ByteReader& reader, Words words) {
    std::vector<double> values;
    for (const std::string_view word : words) {
        values.push_back(parse_real(word).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    if (values.size() != 7) reader.fail_at_line("VIEWPOINT is not 7 numbers", header_cure);
    const Eigen::Vector3d position(values[0], values[1], values[2]);
    const Eigen::Quaterniond rotation(values[3], values[4], values[5], values[6]);
    const double norm = rotation.norm();
    if (position.isZero(0.0) && rotation.vec().isZero(0.0)) return std::nullopt;
    if (!position.allFinite() || !(norm > 1e-6 && norm < 1e6)) {
        reader.fail_at_line("VIEWPOINT is no position and rotation", header_cure);
    }
    Transform pose = Transform::Identity();
    pose.linear() = rotation.normalized().toRotationMatrix();
    pose.translation() = position;
    return pose;
}

/// Takes one header line; true after DATA, the last one.
bool read_header_line(ByteReader& reader, Header& header) {
    const std::vector<std::string_view> line = split_words(reader.read_line());
    if (line.empty() || line[0].starts_with('#')) return false;
    const std::string_view key = line[0];
    const Words words = Words(line).subspan(1);
    const auto one_count = [&] {
        if (words.size() != 1)
            reader.fail_at_line(fmt::format("{} is not one number", key), header_cure);
        return read_count(reader, key, words[0], 0);
    };
    if (key == "VERSION") return false;
    if (key == "FIELDS" || key == "COLUMNS") {
        header.names.assign(words.begin(), words.end());
    } else if (key == "SIZE") {
        header.sizes = read_counts(reader, key, words);
    } else if (key == "TYPE") {
        header.types.clear();
        for (const std::string_view word : words)
            header.types += word.size() == 1 ? word[0] : '?';
    } else if (key == "COUNT") {
        header.counts = read_counts(reader, key, words);
    } else if (key == "WIDTH") {
        header.width = one_count();
    } else if (key == "HEIGHT") {
        header.height = one_count();
    } else if (key == "POINTS") {
        header.num_points = one_count();
    } else if (key == "VIEWPOINT") {
        header.viewpoint = read_viewpoint(reader, words);
    } else if (key == "DATA") {
        header.encoding = words.size() == 1 ? words[0] : "";
        return true;
    } else {
        reader.fail_at_line(fmt::format("{} is no line of a PCD header", quote_text(key)),
                            "if the file is of another format, name it so");
    }
    return false;
}

std::optional<ScalarType> scalar_type(char type, std::uint64_t size) {
    using enum ScalarType;
    if (type == 'F')
        return size == 4   ? std::optional(float32)
               : size == 8 ? std::optional(float64)
                           : std::nullopt;
    const bool is_signed = type == 'I';
    if (!is_signed && type != 'U') return std::nullopt;
    switch (size) {
        case 1:
            return is_signed ? int8 : uint8;
        case 2:
            return is_signed ? int16 : uint16;
        case 4:
            return is_signed ? int32 : uint32;
        case 8:
            return is_signed ? int64 : uint64;
        default:
            return std::nullopt;
    }
}

/// Whether `size` is exactly `num_points` records of `record` bytes.
bool holds_records(std::uint64_t size, std::uint64_t num_points, std::uint64_t record) {
    if (num_points == 0) return size == 0;
    return size % num_points == 0 && size / num_points == record;
}

std::vector<Field> header_fields(const ByteReader& reader, Header& header) {
    const std::size_t num_fields = header.names.size();
    if (header.counts.empty()) header.counts.assign(num_fields, 1);
    if (header.sizes.size() != num_fields || header.types.size() != num_fields ||
        header.counts.size() != num_fields) {
        reader.fail_at_line("FIELDS, SIZE, TYPE and COUNT differ in length", header_cure);
    }
    std::vector<Field> fields;
    for (std::size_t i = 0; i < num_fields; ++i) {
        std::optional<ScalarType> type = scalar_type(header.types[i], header.sizes[i]);
        std::uint64_t count = header.counts[i];
        if (!type && header.names[i] == "_") {
            // Padding is skipped, whatever it says it is.
            type = ScalarType::uint8;
            count *= header.sizes[i];
        }
        if (!type) {
            reader.fail_at_line(
                fmt::format("field {} has TYPE {} and SIZE {}, which is no type",
                            quote_text(header.names[i]), header.types[i], header.sizes[i]),
                header_cure);
        }
        if (count > max_count) reader.fail_at_line("the padding is too wide", header_cure);
        fields.push_back({header.names[i], *type, count});
    }
    if (!PointDecoder::has_positions(fields)) {
        reader.fail_at_line("there are no fields x, y and z", "give the file positions");
    }
    return fields;
}

/// Settles num_points, and the grid where HEIGHT says so.
std::optional<ScanGrid> header_grid(const ByteReader& reader, Header& header) {
    if (!header.num_points && !header.width) {
        reader.fail_at_line("neither POINTS nor WIDTH says how many points there are", header_cure);
    }
    if (!header.width) return std::nullopt;
    const std::uint64_t height = header.height.value_or(1);
    const std::uint64_t cells = *header.width * height;
    if (header.num_points.value_or(cells) != cells) {
        reader.fail_at_line(fmt::format("WIDTH {} times HEIGHT {} is not POINTS {}", *header.width,
                                        height, *header.num_points),
                            header_cure);
    }
    header.num_points = cells;
    if (height <= 1) return std::nullopt;
    return ScanGrid{height, *header.width};
}

PointDecoder decode_ascii(ByteReader& reader, std::span<const Field> fields,
                          std::uint64_t num_points, PointsAs as, const Context& context) {
    std::uint64_t num_values = 0;
    for (const Field& field : fields)
        num_values += field.count;
    // A value takes a digit and a space or line end, which only the very last may lack.
    if (num_points > 0) reader.require_backed(num_points, 2 * num_values - 1, "points");
    PointDecoder decoder(fields, num_points, as);
    decode_text(reader, fields, num_points, false, decoder, context);
    return decoder;
}

PointDecoder decode_binary(ByteReader& reader, std::span<const Field> fields,
                           std::uint64_t num_points, PointsAs as, const Context& context) {
    reader.require_backed(num_points, record_bytes(fields), "points");
    PointDecoder decoder(fields, num_points, as);
    decoder.decode_mapped(reader.take(num_points * record_bytes(fields)), std::endian::little,
                          context);
    return decoder;
}

PointDecoder decode_compressed(ByteReader& reader, std::span<const Field> fields,
                               std::uint64_t num_points, PointsAs as, const Context& context) {
    const auto packed_size = reader.read<std::uint32_t>();
    const auto size = reader.read<std::uint32_t>();
    const auto packed = reader.take(packed_size);

    std::uint64_t padding = 0;
    for (const Field& field : fields)
        padding += field.name == "_" ? field.bytes() : 0;
    const std::uint64_t record = record_bytes(fields);
    // PCL leaves the padding out of the block, others do not: the size tells.
    const bool with_padding = holds_records(size, num_points, record);
    if (!with_padding && !holds_records(size, num_points, record - padding)) {
        reader.fail_at_byte(
            fmt::format("the compressed block claims {} bytes for {} points", size, num_points),
            header_cure);
    }
    if (size > packed_size * max_lzf_ratio) {
        reader.fail_at_byte(fmt::format("{} compressed bytes cannot hold the {} bytes they claim",
                                        packed_size, size),
                            "copy the file again");
    }
    std::vector<std::byte> block(size);
    if (size > 0 && lzf_decompress(packed.data(), packed_size, block.data(), size) != size) {
        reader.fail_at_byte("the compressed block is damaged", "copy the file again");
    }
    std::vector<FieldSource> sources;
    std::size_t offset = 0;
    for (const Field& field : fields) {
        sources.push_back({block.data() + offset, field.bytes()});
        if (with_padding || field.name != "_") offset += num_points * field.bytes();
    }
    PointDecoder decoder(fields, num_points, as);
    decoder.decode(sources, 0, num_points, std::endian::little, context);
    return decoder;
}

PointDecoder decode_points(ByteReader& reader, std::string_view encoding,
                           std::span<const Field> fields, std::uint64_t num_points, PointsAs as,
                           const Context& context) {
    if (encoding == "ascii") return decode_ascii(reader, fields, num_points, as, context);
    if (encoding == "binary") return decode_binary(reader, fields, num_points, as, context);
    if (encoding == "binary_compressed") {
        return decode_compressed(reader, fields, num_points, as, context);
    }
    reader.fail_at_line(fmt::format("DATA {} is no encoding", quote_text(encoding)),
                        "use ascii, binary or binary_compressed");
}

}  // namespace

FileContents read_pcd(const std::filesystem::path& path, PointsAs as, const Context& context) {
    const MappedFile file(path, "PCD");
    ByteReader reader(file, "PCD");
    Header header;
    while (!read_header_line(reader, header)) {
    }
    FileContents contents{{}, "PCD", header.encoding, header_fields(reader, header), {}};
    const std::optional<ScanGrid> grid = header_grid(reader, header);
    decode_points(reader, header.encoding, contents.fields, *header.num_points, as, context)
        .finish(contents, header.viewpoint, grid);
    return contents;
}

}  // namespace roomscribe
