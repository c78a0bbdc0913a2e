// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_encoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/scalar_dispatch.hpp"
#include "roomscribe/io/strided_copy.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk_bytes = 1U << 20U;
constexpr double largest_exact_integer = 0x1p53;

void check_length(std::string_view name, std::size_t length, std::size_t num_points) {
    if (length == 0 || length == num_points) return;
    throw InvalidArgument(name, fmt::format("{} values", length),
                          fmt::format("empty or one per point ({})", num_points));
}

bool is_word(std::string_view name) {
    return !name.empty() &&
           std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c != '\x7f'; });
}

/// The values of a channel as doubles; PLY has no 64-bit integers.
std::vector<double> as_doubles(const Channel& channel) {
    std::vector<double> doubles(channel.values.size() / size_of(channel.type));
    with_scalar_type(channel.type, [&]<typename Value>(std::type_identity<Value>) {
        for (std::size_t i = 0; i < doubles.size(); ++i) {
            Value value;
            std::memcpy(&value, channel.values.data() + i * sizeof(Value), sizeof(Value));
            doubles[i] = static_cast<double>(value);
            if (std::abs(doubles[i]) > largest_exact_integer) {
                throw InvalidArgument("channel " + channel.name, fmt::format("{}", value),
                                      "within +-2^53 for PLY; PCD holds any");
            }
        }
    });
    return doubles;
}

}  // namespace

void check_cloud(const PointCloud& cloud) {
    check_length("normals", cloud.normals.size(), cloud.size());
    check_length("colors", cloud.colors.size(), cloud.size());
    check_length("intensities", cloud.intensities.size(), cloud.size());
    for (const Channel& channel : cloud.channels) {
        if (!is_word(channel.name)) {
            throw InvalidArgument("channel name", quote_text(channel.name),
                                  "a word without spaces");
        }
        if (channel.count == 0 ||
            channel.values.size() != cloud.size() * channel.bytes_per_point()) {
            throw InvalidArgument("channel " + channel.name,
                                  fmt::format("{} bytes", channel.values.size()),
                                  fmt::format("{} values per point, of at least 1", channel.count));
        }
    }
    if (cloud.grid && cloud.grid->rows * cloud.grid->columns != cloud.size()) {
        throw InvalidArgument("grid", fmt::format("{} x {}", cloud.grid->rows, cloud.grid->columns),
                              fmt::format("as many cells as points ({})", cloud.size()));
    }
}

PointColumns::PointColumns(const PointCloud& cloud, FieldStyle style) : num_points_(cloud.size()) {
    check_cloud(cloud);
    add_positions(cloud);
    if (!cloud.normals.empty()) {
        const std::array<std::string, 3> names =
            style == FieldStyle::pcd
                ? std::array<std::string, 3>{"normal_x", "normal_y", "normal_z"}
                : std::array<std::string, 3>{"nx", "ny", "nz"};
        for (std::size_t k = 0; k < 3; ++k) {
            add(names[k], ScalarType::float32, cloud.normals.data()->data() + k,
                sizeof(Eigen::Vector3f));
        }
    }
    if (!cloud.colors.empty()) add_colors(cloud, style);
    if (!cloud.intensities.empty()) {
        add("intensity", ScalarType::float32, cloud.intensities.data(), sizeof(float));
    }
    for (const Channel& channel : cloud.channels)
        add_channel(channel, style);
}

std::size_t PointColumns::record_bytes() const {
    std::size_t bytes = 0;
    for (const FieldColumn& column : columns_)
        bytes += column.field.bytes();
    return bytes;
}

void PointColumns::add(std::string name, ScalarType type, const void* first, std::size_t stride) {
    columns_.push_back({{std::move(name), type, 1}, static_cast<const std::byte*>(first), stride});
}

void PointColumns::add_positions(const PointCloud& cloud) {
    const std::array<std::string, 3> names = {"x", "y", "z"};
    if (cloud.global_shift.isZero(0.0)) {
        const auto* first = reinterpret_cast<const float*>(cloud.positions.data());
        for (std::size_t k = 0; k < 3; ++k) {
            add(names[k], ScalarType::float32, cloud.empty() ? nullptr : first + k,
                sizeof(Eigen::Vector3f));
        }
        return;
    }
    std::vector<double>& far = doubles_.emplace_back(3 * cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        Eigen::Map<Eigen::Vector3d> position(far.data() + 3 * i);
        position = cloud.positions[i].cast<double>() + cloud.global_shift;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        add(names[k], ScalarType::float64, cloud.empty() ? nullptr : far.data() + k,
            3 * sizeof(double));
    }
}

void PointColumns::add_colors(const PointCloud& cloud, FieldStyle style) {
    if (style != FieldStyle::pcd) {
        const std::array<std::string, 3> names = {"red", "green", "blue"};
        for (std::size_t k = 0; k < 3; ++k) {
            add(names[k], ScalarType::uint8, cloud.colors.data()->data() + k, 3);
        }
        return;
    }
    packed_colors_.reserve(cloud.size());
    for (const auto& [red, green, blue] : cloud.colors) {
        packed_colors_.push_back(static_cast<std::uint32_t>(red) << 16U |
                                 static_cast<std::uint32_t>(green) << 8U | blue);
    }
    add("rgb", ScalarType::uint32, packed_colors_.data(), sizeof(std::uint32_t));
}

void PointColumns::add_channel(const Channel& channel, FieldStyle style) {
    if (style == FieldStyle::pcd) {
        columns_.push_back({{channel.name, channel.type, channel.count},
                            channel.values.data(),
                            channel.bytes_per_point()});
        return;
    }
    const bool widened = style == FieldStyle::ply &&
                         (channel.type == ScalarType::int64 || channel.type == ScalarType::uint64);
    const ScalarType type = widened ? ScalarType::float64 : channel.type;
    const std::byte* first = channel.values.data();
    if (widened) {
        first =
            reinterpret_cast<const std::byte*>(doubles_.emplace_back(as_doubles(channel)).data());
    }
    for (std::size_t k = 0; k < channel.count; ++k) {
        add(channel.count == 1 ? channel.name : fmt::format("{}_{}", channel.name, k), type,
            first == nullptr ? nullptr : first + k * size_of(type), channel.count * size_of(type));
    }
}

void write_records(AtomicFile& file, const PointColumns& points, std::endian order,
                   const Context& context) {
    const std::span<const FieldColumn> columns = points.columns();
    const std::size_t record = points.record_bytes();
    const bool swap = order != std::endian::native;
    const std::size_t rows = std::max<std::size_t>(1, chunk_bytes / record);
    std::vector<std::byte> records(std::min(rows, points.num_points()) * record);
    for (std::size_t first = 0; first < points.num_points(); first += rows) {
        context.throw_if_cancelled();
        const std::size_t count = std::min(rows, points.num_points() - first);
        std::byte* target = records.data();
        for (std::size_t i = 0; i < columns.size();) {
            const FieldColumn& column = columns[i];
            const std::size_t size = size_of(column.field.type);
            // Columns that lie side by side in memory, as x y z do, are copied at once.
            std::size_t num_values = column.field.count;
            std::size_t next = i + 1;
            while (next < columns.size() && columns[next].field.type == column.field.type &&
                   columns[next].stride == column.stride &&
                   columns[next].first == column.first + num_values * size &&
                   num_values * size < column.stride) {
                num_values += columns[next++].field.count;
            }
            copy_values(target, record, column.first + first * column.stride, column.stride, size,
                        num_values, count, swap);
            target += num_values * size;
            i = next;
        }
        file.write(std::span<const std::byte>(records.data(), count * record));
    }
}

void write_text(AtomicFile& file, const PointColumns& points, const Context& context,
                char separator) {
    std::string text;
    for (std::size_t i = 0; i < points.num_points(); ++i) {
        for (const FieldColumn& column : points.columns()) {
            const std::byte* value = column.first + i * column.stride;
            for (std::size_t k = 0; k < column.field.count; ++k) {
                append_number(text, column.field.type, value + k * size_of(column.field.type));
                text += separator;
            }
        }
        text.back() = '\n';
        if (text.size() >= chunk_bytes || i + 1 == points.num_points()) {
            context.throw_if_cancelled();
            file.write(text);
            text.clear();
        }
    }
}

}  // namespace roomscribe
