// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/las.hpp"
#include "roomscribe/io/las_format.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view cure = "the file is damaged: copy or export it again";
constexpr std::string_view laz_cure =
    "open it with 'laszip -i FILE.laz -o FILE.las' or 'pdal translate FILE.laz FILE.las'";
/// Records of so many points stay in the cache while one field after another is taken from them.
constexpr std::size_t points_per_chunk = 1U << 10U;
/// And so many before their memory is given back, which has its price.
constexpr std::size_t points_per_run = 1U << 17U;
/// LASzip sets it in the number of the point format.
constexpr unsigned compressed_bit = 0x80;
/// Formats 0 to 5 have three flags above the class.
constexpr std::byte legacy_class_mask{0x1f};

struct Header {
    unsigned minor = 0;
    unsigned point_format = 0;
    std::size_t header_size = 0;
    std::size_t first_point = 0;
    std::uint32_t num_records = 0;  ///< of variable length, between header and points
    std::size_t record_bytes = 0;
    std::uint64_t num_points = 0;
    Eigen::Vector3d scale;
    Eigen::Vector3d offset;
};

Eigen::Vector3d read_vector(ByteReader& reader) {
    Eigen::Vector3d vector;
    for (double& value : vector)
        value = reader.read<double>();
    return vector;
}

void check_point_format(const ByteReader& reader, unsigned format) {
    if ((format & compressed_bit) != 0) {
        reader.fail_at_byte("the points are compressed (LAZ), which is not read", laz_cure);
    }
    if (format >= num_las_point_formats) {
        reader.fail_at_byte(fmt::format("point format {} is not one of 0 to 10", format), cure);
    }
}

Header read_header(ByteReader& reader) {
    Header header;
    if (!reader.remaining_text().starts_with(las_magic)) {
        reader.fail_at_byte("it does not begin with LASF",
                            "if the file is of another format, name it so");
    }
    reader.take(24);
    const unsigned major = reader.read<std::uint8_t>();
    header.minor = reader.read<std::uint8_t>();
    if (major != 1 || header.minor > 4) {
        reader.fail_at_byte(fmt::format("LAS {}.{} is not read", major, header.minor),
                            "write it as LAS 1.2 to 1.4");
    }
    reader.take(68);
    header.header_size = reader.read<std::uint16_t>();
    header.first_point = reader.read<std::uint32_t>();
    header.num_records = reader.read<std::uint32_t>();
    header.point_format = reader.read<std::uint8_t>();
    check_point_format(reader, header.point_format);
    header.record_bytes = reader.read<std::uint16_t>();
    header.num_points = reader.read<std::uint32_t>();
    reader.take(20);
    header.scale = read_vector(reader);
    header.offset = read_vector(reader);
    if (!header.scale.allFinite() || !header.offset.allFinite() ||
        header.scale.cwiseAbs().minCoeff() <= 0.0) {
        reader.fail_at_byte("the scale or offset of the coordinates is none", cure);
    }
    reader.take(48);
    if (header.minor == 4 && header.header_size >= 375) {
        reader.take(20);
        const auto count = reader.read<std::uint64_t>();
        if (count > 0) header.num_points = count;
    }
    return header;
}

/// Appends the fields of one record of extra bytes.
void read_extra_bytes(ByteReader record, std::size_t size, std::vector<Field>& fields) {
    for (std::size_t i = 0; i < size / extra_bytes_size; ++i) {
        record.skip(2);
        const unsigned type = record.read<std::uint8_t>();
        const unsigned options = record.read<std::uint8_t>();
        const std::string_view name_field = record.remaining_text().substr(0, 32);
        std::string name(name_field.substr(0, name_field.find('\0')));
        for (char& c : name) {
            if (c <= ' ' || c > '~') c = '_';
        }
        record.skip(extra_bytes_size - 4);
        constexpr std::size_t num_types = std::size(extra_bytes_types);
        if (name.empty()) name = fmt::format("extra_{}", i);
        if (type == 0) {
            if (options > 0) fields.push_back({"_", ScalarType::uint8, options});
        } else if (type <= 3 * num_types) {
            // 11 to 30 are pairs and triples of the first ten.
            fields.push_back(
                {name, extra_bytes_types[(type - 1) % num_types], 1 + (type - 1) / num_types});
        } else {
            return;
        }
    }
}

/// The fields of the extra bytes behind each point, as the records before the points tell them.
std::vector<Field> read_extra_fields(ByteReader reader, const Header& header) {
    std::vector<Field> fields;
    if (header.header_size < reader.position()) {
        reader.fail_at_byte(fmt::format("the header claims {} bytes", header.header_size), cure);
    }
    reader.take(header.header_size - reader.position());
    for (std::uint32_t i = 0; i < header.num_records; ++i) {
        reader.take(2);
        const std::string_view user = reader.remaining_text().substr(0, 16);
        reader.take(16);
        const auto id = reader.read<std::uint16_t>();
        const auto size = reader.read<std::uint16_t>();
        reader.take(32);
        const ByteReader record = reader;
        reader.take(size);
        if (user.starts_with(las_spec_user) && id == extra_bytes_record) {
            read_extra_bytes(record, size, fields);
        }
    }
    return fields;
}

/// All fields of a record; bytes that nobody describes are padding.
std::vector<Field> record_fields(const ByteReader& reader, const Header& header) {
    std::vector<Field> fields = las_fields(header.point_format);
    const std::size_t needed = record_bytes(fields);
    if (header.record_bytes < needed) {
        reader.fail_at_byte(fmt::format("points of {} bytes are too short for format {}",
                                        header.record_bytes, header.point_format),
                            cure);
    }
    std::size_t left = header.record_bytes - needed;
    for (const Field& field : read_extra_fields(reader, header)) {
        if (field.bytes() > left) break;
        left -= field.bytes();
        // A name that is taken would make two channels of one name.
        const bool taken = std::any_of(fields.begin(), fields.end(), [&](const Field& other) {
            return other.name == field.name && field.name != "_";
        });
        fields.push_back({taken ? "extra_" + field.name : field.name, field.type, field.count});
    }
    if (left > 0) fields.push_back({"_", ScalarType::uint8, left});
    return fields;
}

bool is_wide_color(const Field& field) {
    return field.type == ScalarType::uint16 &&
           (field.name == "red" || field.name == "green" || field.name == "blue");
}

/// Fields of which every point has zeros tell nothing and cost memory: of the unused ones of the
/// many fields that LAS always has, no channel is made.
using RecordBits = std::vector<std::byte>;

/// The bits that are set in any of the records.
RecordBits find_used_bits(const std::byte* records, std::size_t record_bytes, std::size_t count,
                          const Context& context) {
    const auto gather = [&](std::size_t begin, std::size_t end) {
        RecordBits bits(record_bytes);
        constexpr std::size_t word = sizeof(std::uint64_t);
        for (std::size_t first = begin; first < end; first += points_per_chunk) {
            const std::size_t last = std::min(first + points_per_chunk, end);
            // The last word may overlap the one before. No record has less than 20 bytes.
            for (std::size_t at = 0; at < record_bytes; at += word) {
                const std::size_t place = std::min(at, record_bytes - word);
                std::uint64_t all = 0;
                std::memcpy(&all, bits.data() + place, word);
                for (std::size_t i = first; i < last; ++i) {
                    std::uint64_t some = 0;
                    std::memcpy(&some, records + i * record_bytes + place, word);
                    all |= some;
                }
                std::memcpy(bits.data() + place, &all, word);
            }
        }
        let_go({records + begin * record_bytes, (end - begin) * record_bytes});
        return bits;
    };
    const auto join = [](RecordBits a, RecordBits b) {
        std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::bit_or<>());
        return a;
    };
    return parallel_reduce(context, count, points_per_run, RecordBits(record_bytes), gather, join);
}

/// The fields as the decoder is to take them: the class always, of the others what is used.
/// Colours have 16 bits, which it does not take.
std::vector<Field> fields_to_decode(std::span<const Field> fields, const RecordBits& used) {
    std::vector<Field> decoded(fields.begin(), fields.end());
    auto first = used.begin();
    for (Field& field : decoded) {
        const auto last = first + static_cast<std::ptrdiff_t>(field.bytes());
        const bool unused = std::all_of(first, last, [](std::byte b) { return b == std::byte{0}; });
        const bool position = field.name == "x" || field.name == "y" || field.name == "z";
        if (is_wide_color(field) || (unused && !position && field.name != "classification")) {
            field = {"_", ScalarType::uint8, field.bytes()};
        }
        first = last;
    }
    return decoded;
}

/// Where the colours stand in a record; empty if there are none.
std::optional<std::size_t> color_offset(std::span<const Field> fields) {
    std::size_t offset = 0;
    for (const Field& field : fields) {
        if (is_wide_color(field)) return offset;
        offset += field.bytes();
    }
    return std::nullopt;
}

/// `used` are the bits of the colours: one above 255 says that all have 16 bits.
void decode_colors(PointCloud& cloud, const std::byte* first, std::size_t stride,
                   std::span<const std::byte> used, const Context& context) {
    const bool wide = used[1] != std::byte{0} || used[3] != std::byte{0} || used[5] != std::byte{0};
    const std::byte* const taken = first + (wide ? 1 : 0);
    cloud.colors.resize(cloud.size());
    parallel_for(context, cloud.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::byte* const color = taken + i * stride;
            for (std::size_t k = 0; k < 3; ++k)
                cloud.colors[i][k] = std::to_integer<std::uint8_t>(color[2 * k]);
        }
    });
}

void mask_legacy_classes(PointCloud& cloud) {
    for (Channel& channel : cloud.channels) {
        if (channel.name != "classification") continue;
        for (std::byte& value : channel.values)
            value &= legacy_class_mask;
    }
}

}  // namespace

FileContents read_las(const std::filesystem::path& path, PointsAs as, const Context& context) {
    const MappedFile file(path, "LAS");
    ByteReader reader(file, "LAS");
    const Header header = read_header(reader);
    const std::vector<Field> fields = record_fields(reader, header);
    if (header.first_point < std::max(header.header_size, reader.position()) ||
        header.first_point > file.bytes().size()) {
        reader.fail_at_byte(fmt::format("the points cannot begin at byte {}", header.first_point),
                            cure);
    }
    reader.skip(header.first_point - reader.position());
    reader.require_backed_at_byte(header.num_points, header.record_bytes, "points");
    const auto num_points = static_cast<std::size_t>(header.num_points);
    const std::byte* const records = reader.take(num_points * header.record_bytes).data();

    const RecordBits used = find_used_bits(records, header.record_bytes, num_points, context);
    PointDecoder decoder(fields_to_decode(fields, used), num_points, as);
    decoder.quantize_positions(header.scale, header.offset);
    decoder.decode_mapped({records, num_points * header.record_bytes}, std::endian::little,
                          context);
    FileContents contents;
    contents.format = "LAS";
    contents.encoding = fmt::format("1.{}, point format {}", header.minor, header.point_format);
    decoder.finish(contents, std::nullopt, std::nullopt);
    for (const Field& field : fields) {
        if (field.name != "_") contents.fields.push_back(field);
    }
    const auto offset = color_offset(fields);
    if (offset && as == PointsAs::cloud) {
        decode_colors(contents.cloud, records + *offset, header.record_bytes,
                      std::span(used).subspan(*offset), context);
    }
    if (header.point_format < 6) mask_legacy_classes(contents.cloud);
    return contents;
}

}  // namespace roomscribe
