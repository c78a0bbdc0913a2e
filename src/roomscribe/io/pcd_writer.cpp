// SPDX-License-Identifier: MIT
#include <limits>

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/pcd.hpp"
#include "roomscribe/io/point_encoder.hpp"
#include "roomscribe/io/strided_copy.hpp"

namespace roomscribe {
namespace {

char type_letter(ScalarType type) {
    switch (type) {
        case ScalarType::float32:
        case ScalarType::float64:
            return 'F';
        case ScalarType::int8:
        case ScalarType::int16:
        case ScalarType::int32:
        case ScalarType::int64:
            return 'I';
        default:
            return 'U';
    }
}

std::string_view encoding_name(Encoding encoding) {
    switch (encoding) {
        case Encoding::ascii:
            return "ascii";
        case Encoding::automatic:
        case Encoding::binary:
            return "binary";
        case Encoding::binary_compressed:
            return "binary_compressed";
        case Encoding::binary_big_endian:
            break;
    }
    throw InvalidArgument("encoding", "binary_big_endian",
                          "ascii, binary or binary_compressed for PCD");
}

std::string viewpoint_text(const PointCloud& cloud) {
    if (!cloud.sensor_pose) return "0 0 0 1 0 0 0";
    const Eigen::Vector3d position = cloud.sensor_pose->translation() + cloud.global_shift;
    const Eigen::Quaterniond rotation(cloud.sensor_pose->linear());
    return fmt::format("{} {} {} {} {} {} {}", position.x(), position.y(), position.z(),
                       rotation.w(), rotation.x(), rotation.y(), rotation.z());
}

std::string header_text(const PointCloud& cloud, const PointColumns& points, Encoding encoding) {
    std::string names, sizes, types, counts;
    for (const FieldColumn& column : points.columns()) {
        names += " " + column.field.name;
        sizes += fmt::format(" {}", size_of(column.field.type));
        types += fmt::format(" {}", type_letter(column.field.type));
        counts += fmt::format(" {}", column.field.count);
    }
    const ScanGrid grid = cloud.grid.value_or(ScanGrid{1, cloud.size()});
    return fmt::format(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\n"
        "COUNT{}\nWIDTH {}\nHEIGHT {}\nVIEWPOINT {}\nPOINTS {}\nDATA {}\n",
        names, sizes, types, counts, grid.columns, grid.rows, viewpoint_text(cloud), cloud.size(),
        encoding_name(encoding));
}

void write_size(AtomicFile& file, std::size_t size) {
    auto bytes = static_cast<std::uint32_t>(size);
    if constexpr (std::endian::native != std::endian::little) bytes = swap_bytes(bytes);
    file.write(std::as_bytes(std::span(&bytes, 1)));
}

/// Field by field, as PCL does: equal neighbours compress well.
void write_compressed(AtomicFile& file, const PointColumns& points) {
    constexpr bool swap = std::endian::native != std::endian::little;
    const std::size_t size = points.num_points() * points.record_bytes();
    // LZF at its worst adds one byte to 32.
    const std::size_t max_packed = size + size / 16 + 64;
    if (max_packed > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidArgument("encoding", "binary_compressed",
                              "binary for a cloud of more than 4 GB");
    }
    std::vector<std::byte> block(size);
    std::byte* target = block.data();
    for (const FieldColumn& column : points.columns()) {
        const std::size_t bytes = column.field.bytes();
        copy_values(target, bytes, column.first, column.stride, size_of(column.field.type),
                    column.field.count, points.num_points(), swap);
        target += points.num_points() * bytes;
    }
    std::vector<std::byte> packed(max_packed);
    const std::size_t packed_size =
        size == 0 ? 0
                  : lzf_compress(block.data(), static_cast<unsigned>(size), packed.data(),
                                 static_cast<unsigned>(max_packed));
    write_size(file, packed_size);
    write_size(file, size);
    file.write(std::span<const std::byte>(packed.data(), packed_size));
}

}  // namespace

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding,
               const Context& context) {
    const PointColumns points(cloud, FieldStyle::pcd);
    const std::string header = header_text(cloud, points, encoding);
    AtomicFile file(path, "PCD");
    file.write(header);
    if (encoding == Encoding::ascii) {
        write_text(file, points, context);
    } else if (encoding == Encoding::binary_compressed) {
        write_compressed(file, points);
    } else {
        write_records(file, points, std::endian::little, context);
    }
    file.commit();
}

}  // namespace roomscribe
