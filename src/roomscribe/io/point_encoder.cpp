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

/// Values of a channel as doubles; PLY has no 64-bit integers.
std::vector<double> as_doubles(const Channel& channel, PointRange range) {
    std::vector<double> doubles(range.count * channel.count);
    const std::byte* first = channel.values.data() + range.first * channel.bytes_per_point();
    with_scalar_type(channel.type, [&]<typename Value>(std::type_identity<Value>) {
        for (std::size_t i = 0; i < doubles.size(); ++i) {
            Value value;
            std::memcpy(&value, first + i * sizeof(Value), sizeof(Value));
            doubles[i] = static_cast<double>(value);
            if (std::abs(doubles[i]) > largest_exact_integer) {
                throw InvalidArgument("channel " + channel.name, fmt::format("{}", value),
                                      "within +-2^53 for PLY; PCD holds any");
            }
        }
    });
    return doubles;
}

/// The cloud's channels keep their names, but for those that are taken.
std::vector<std::string> channel_names(const PointCloud& cloud, std::span<const ChannelView> more) {
    std::vector<std::string> names;
    for (const Channel& channel : cloud.channels)
        names.push_back(channel.name);
    const auto is_taken = [&](const std::string& name) {
        return std::any_of(more.begin(), more.end(),
                           [&name](const ChannelView& view) { return view.name == name; });
    };
    for (std::string& name : names) {
        if (!is_taken(name)) continue;
        std::string free_name = "input_" + name;
        while (is_taken(free_name) ||
               std::find(names.begin(), names.end(), free_name) != names.end())
            free_name.insert(0, "input_");
        name = free_name;
    }
    return names;
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

PointColumns::PointColumns(const PointCloud& cloud, FieldStyle style)
    : PointColumns(cloud, style, {0, cloud.size()}, {}) {}

PointColumns::PointColumns(const PointCloud& cloud, FieldStyle style, PointRange range,
                           std::span<const ChannelView> more)
    : range_(range) {
    check_cloud(cloud);
    add_positions(cloud);
    if (!cloud.normals.empty()) {
        const std::array<std::string, 3> names =
            style == FieldStyle::pcd
                ? std::array<std::string, 3>{"normal_x", "normal_y", "normal_z"}
                : std::array<std::string, 3>{"nx", "ny", "nz"};
        for (std::size_t k = 0; k < 3; ++k) {
            add(names[k], ScalarType::float32, (cloud.normals.data() + range.first)->data() + k,
                sizeof(Eigen::Vector3f));
        }
    }
    if (!cloud.colors.empty()) add_colors(cloud, style);
    if (!cloud.intensities.empty()) {
        add("intensity", ScalarType::float32, cloud.intensities.data() + range.first,
            sizeof(float));
    }
    const std::vector<std::string> names = channel_names(cloud, more);
    for (std::size_t i = 0; i < cloud.channels.size(); ++i)
        add_channel(cloud.channels[i], names[i], style);
    for (const ChannelView& view : more) {
        check_length(view.name, view.values.size() / size_of(view.type), cloud.size());
        add(std::string(view.name), view.type,
            view.values.data() + range.first * size_of(view.type), size_of(view.type));
    }
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
        const auto* first = reinterpret_cast<const float*>(cloud.positions.data() + range_.first);
        for (std::size_t k = 0; k < 3; ++k) {
            add(names[k], ScalarType::float32, cloud.empty() ? nullptr : first + k,
                sizeof(Eigen::Vector3f));
        }
        return;
    }
    std::vector<double>& far = doubles_.emplace_back(3 * range_.count);
    for (std::size_t i = 0; i < range_.count; ++i) {
        Eigen::Map<Eigen::Vector3d> position(far.data() + 3 * i);
        position = cloud.positions[range_.first + i].cast<double>() + cloud.global_shift;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        add(names[k], ScalarType::float64, far.empty() ? nullptr : far.data() + k,
            3 * sizeof(double));
    }
}

void PointColumns::add_colors(const PointCloud& cloud, FieldStyle style) {
    if (style != FieldStyle::pcd) {
        const std::array<std::string, 3> names = {"red", "green", "blue"};
        for (std::size_t k = 0; k < 3; ++k) {
            add(names[k], ScalarType::uint8, (cloud.colors.data() + range_.first)->data() + k, 3);
        }
        return;
    }
    packed_colors_.reserve(range_.count);
    for (const auto& [red, green, blue] :
         std::span(cloud.colors).subspan(range_.first, range_.count)) {
        packed_colors_.push_back(static_cast<std::uint32_t>(red) << 16U |
                                 static_cast<std::uint32_t>(green) << 8U | blue);
    }
    add("rgb", ScalarType::uint32, packed_colors_.data(), sizeof(std::uint32_t));
}

void PointColumns::add_channel(const Channel& channel, std::string name, FieldStyle style) {
    const std::byte* first = channel.values.data();
    if (first != nullptr) first += range_.first * channel.bytes_per_point();
    if (style == FieldStyle::pcd) {
        columns_.push_back(
            {{std::move(name), channel.type, channel.count}, first, channel.bytes_per_point()});
        return;
    }
    const bool widened = style == FieldStyle::ply &&
                         (channel.type == ScalarType::int64 || channel.type == ScalarType::uint64);
    const ScalarType type = widened ? ScalarType::float64 : channel.type;
    if (widened) {
        first = reinterpret_cast<const std::byte*>(
            doubles_.emplace_back(as_doubles(channel, range_)).data());
    }
    for (std::size_t k = 0; k < channel.count; ++k) {
        add(channel.count == 1 ? name : fmt::format("{}_{}", name, k), type,
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
