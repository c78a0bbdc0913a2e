// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/ply.hpp"
#include "roomscribe/io/point_encoder.hpp"

namespace roomscribe {
namespace {

/// The properties of PCL's camera element. It wants all of them; the pose is the first twelve.
constexpr std::array<std::string_view, 21> camera_properties = {
    "float view_px", "float view_py", "float view_pz", "float x_axisx", "float x_axisy",
    "float x_axisz", "float y_axisx", "float y_axisy", "float y_axisz", "float z_axisx",
    "float z_axisy", "float z_axisz", "float focal",   "float scalex",  "float scaley",
    "float centerx", "float centery", "int viewportx", "int viewporty", "float k1",
    "float k2"};

std::string_view encoding_name(Encoding encoding) {
    switch (encoding) {
        case Encoding::ascii:
            return "ascii";
        case Encoding::automatic:
        case Encoding::binary:
            return "binary_little_endian";
        case Encoding::binary_big_endian:
            return "binary_big_endian";
        case Encoding::binary_compressed:
            break;
    }
    throw InvalidArgument("encoding", "binary_compressed",
                          "ascii, binary or binary_big_endian for PLY");
}

/// What must be converted before it is written is so for so many points at once.
constexpr std::size_t points_per_part = 1U << 20U;

/// PLY's own names: "uchar" is understood everywhere, "uint8" is not.
std::string_view type_name(ScalarType type) {
    switch (type) {
        case ScalarType::int8:
            return "char";
        case ScalarType::uint8:
            return "uchar";
        case ScalarType::int16:
            return "short";
        case ScalarType::uint16:
            return "ushort";
        case ScalarType::int32:
            return "int";
        case ScalarType::uint32:
            return "uint";
        case ScalarType::float32:
            return "float";
        default:
            return "double";
    }
}

std::string header_text(const PointCloud& cloud, const PointColumns& points, Encoding encoding) {
    std::string text = fmt::format("ply\nformat {} 1.0\n", encoding_name(encoding));
    if (cloud.grid) {
        text += fmt::format("obj_info num_cols {}\nobj_info num_rows {}\n", cloud.grid->columns,
                            cloud.grid->rows);
    }
    text += fmt::format("element vertex {}\n", cloud.size());
    for (const FieldColumn& column : points.columns()) {
        text += fmt::format("property {} {}\n", type_name(column.field.type), column.field.name);
    }
    if (cloud.sensor_pose) {
        text += "element camera 1\n";
        for (const std::string_view property : camera_properties) {
            text += fmt::format("property {}\n", property);
        }
    }
    return text + "end_header\n";
}

void write_camera(AtomicFile& file, const PointCloud& cloud, Encoding encoding) {
    std::array<float, camera_properties.size()> values{};
    const Eigen::Vector3d position = cloud.sensor_pose->translation() + cloud.global_shift;
    for (Eigen::Index row = 0; row < 3; ++row) {
        const auto i = static_cast<std::size_t>(row);
        values[i] = static_cast<float>(position[row]);
        for (std::size_t column = 0; column < 3; ++column) {
            values[3 + 3 * i + column] = static_cast<float>(
                cloud.sensor_pose->linear()(row, static_cast<Eigen::Index>(column)));
        }
    }
    // What is no part of the pose stays 0, which has the same bits as int and float.
    std::string text;
    const bool swap =
        (encoding == Encoding::binary_big_endian) == (std::endian::native == std::endian::little);
    for (float value : values) {
        if (encoding == Encoding::ascii) {
            append_number(text, ScalarType::float32, reinterpret_cast<const std::byte*>(&value));
            text += ' ';
        } else {
            if (swap) value = swap_bytes(value);
            file.write(std::as_bytes(std::span(&value, 1)));
        }
    }
    if (encoding == Encoding::ascii) file.write(text + "\n");
}

}  // namespace

void write_ply(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding,
               const Context& context) {
    write_ply(path, cloud, {}, encoding, context);
}

void write_ply(const std::filesystem::path& path, const PointCloud& cloud,
               std::span<const ChannelView> more, Encoding encoding, const Context& context) {
    const std::string header =
        header_text(cloud, PointColumns(cloud, FieldStyle::ply, {0, 0}, more), encoding);
    AtomicFile file(path, "PLY");
    file.write(header);
    for (std::size_t first = 0; first < cloud.size(); first += points_per_part) {
        const PointRange range{first, std::min(points_per_part, cloud.size() - first)};
        const PointColumns points(cloud, FieldStyle::ply, range, more);
        if (encoding == Encoding::ascii) {
            write_text(file, points, context);
        } else {
            const bool big = encoding == Encoding::binary_big_endian;
            write_records(file, points, big ? std::endian::big : std::endian::little, context);
        }
    }
    if (cloud.sensor_pose) write_camera(file, cloud, encoding);
    file.commit();
}

}  // namespace roomscribe
