// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_writer.hpp"
#include "roomscribe/io/las.hpp"
#include "roomscribe/io/las_format.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/point_encoder.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t header_bytes = 375;
/// Finer than any scanner of rooms, and about what float32 holds within a kilometre.
constexpr double finest_step = 1e-4;
constexpr double largest_step_count = 2147483647.0;
constexpr double largest_uint16 = 65535.0;
constexpr std::size_t points_per_chunk = 1U << 14U;
/// Of formats 6 to 10: the coordinate system, if there is one, is told as well-known text.
constexpr std::uint16_t encoding_flags = 0x10;
constexpr std::byte only_return{0x11};  ///< number 1 of 1

/// Where one field of a record comes from; without a column it stays 0.
struct Placed {
    std::size_t offset = 0;
    std::size_t bytes = 0;
    const FieldColumn* column = nullptr;
};

struct Layout {
    unsigned point_format = 6;
    std::vector<Placed> copied;  ///< what goes from the cloud into a record as it is
    std::vector<Field> extra;
    std::size_t color_offset = 0;
    std::size_t record_bytes = 0;
};

const FieldColumn* find_column(const PointColumns& points, const Field& field) {
    for (const FieldColumn& column : points.columns()) {
        if (column.field.name == field.name && column.field.type == field.type) return &column;
    }
    return nullptr;
}

bool has_own_place(const std::string& name) {
    constexpr std::array<std::string_view, 7> names = {"x",     "y",    "z",        "red",
                                                       "green", "blue", "intensity"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

Layout make_layout(const PointCloud& cloud, const PointColumns& points) {
    Layout layout;
    layout.point_format = cloud.colors.empty() ? 6 : 7;
    std::vector<const FieldColumn*> placed;
    for (const Field& field : las_fields(layout.point_format)) {
        if (field.name == "red") layout.color_offset = layout.record_bytes;
        const FieldColumn* column =
            has_own_place(field.name) ? nullptr : find_column(points, field);
        if (column != nullptr) {
            layout.copied.push_back({layout.record_bytes, field.bytes(), column});
            placed.push_back(column);
        }
        layout.record_bytes += field.bytes();
    }
    for (const FieldColumn& column : points.columns()) {
        if (has_own_place(column.field.name) ||
            std::find(placed.begin(), placed.end(), &column) != placed.end()) {
            continue;
        }
        layout.copied.push_back({layout.record_bytes, column.field.bytes(), &column});
        layout.extra.push_back(column.field);
        layout.record_bytes += column.field.bytes();
    }
    const std::size_t largest = 65535;
    if (layout.extra.size() * extra_bytes_size > largest || layout.record_bytes > largest) {
        throw InvalidArgument("channels", fmt::format("{}", layout.extra.size()),
                              "at most 341 for LAS");
    }
    return layout;
}

/// How the coordinates become integers.
struct Steps {
    Eigen::Vector3d scale = Eigen::Vector3d::Constant(finest_step);
    Eigen::Vector3d min = Eigen::Vector3d::Zero();  ///< of all points, less the global shift
    Eigen::Vector3d max = Eigen::Vector3d::Zero();
};

Steps choose_steps(const PointCloud& cloud) {
    Steps steps;
    if (cloud.empty()) return steps;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& point : cloud.positions)
        box.extend(point.cast<double>());
    for (Eigen::Index k = 0; k < 3; ++k) {
        const double reach = std::max(std::abs(box.min()[k]), std::abs(box.max()[k]));
        while (reach / steps.scale[k] >= largest_step_count)
            steps.scale[k] *= 10.0;
    }
    const auto on_step = [&](const Eigen::Vector3d& point) {
        return point.cwiseQuotient(steps.scale).array().round().matrix().cwiseProduct(steps.scale);
    };
    steps.min = on_step(box.min());
    steps.max = on_step(box.max());
    return steps;
}

/// Intensities as 16 bits: value * scale + offset.
struct IntensityRange {
    double scale = 1.0;
    double offset = 0.0;
};

IntensityRange intensity_range(std::span<const float> intensities) {
    double low = 0.0;
    double high = 0.0;
    bool whole = true;
    bool first = true;
    for (const float value : intensities) {
        if (!std::isfinite(value)) continue;
        const double wide = value;
        low = first ? wide : std::min(low, wide);
        high = first ? wide : std::max(high, wide);
        whole = whole && wide == std::floor(wide);
        first = false;
    }
    if (whole && low >= 0.0 && high <= largest_uint16) return {};
    const double scale = high > low ? largest_uint16 / (high - low) : 1.0;
    return {scale, -low * scale};
}

std::string extra_bytes_text(std::span<const Field> fields) {
    ByteWriter text;
    if (fields.empty()) return {};
    text.add<std::uint16_t>(0);
    text.add_text(las_spec_user, 16);
    text.add(extra_bytes_record);
    text.add(static_cast<std::uint16_t>(fields.size() * extra_bytes_size));
    text.add_text("Extra Bytes", 32);
    for (const Field& field : fields) {
        const auto* const type =
            std::find(std::begin(extra_bytes_types), std::end(extra_bytes_types), field.type);
        text.add<std::uint16_t>(0);
        text.add(static_cast<std::uint8_t>(type - std::begin(extra_bytes_types) + 1));
        text.add<std::uint8_t>(0);
        text.add_text(field.name, 32);
        text.add_text("", extra_bytes_size - 36);
    }
    return text.bytes();
}

std::string header_text(const PointCloud& cloud, const Layout& layout, const Steps& steps,
                        const std::string& extra) {
    ByteWriter text;
    text.add_text(las_magic, 4);
    text.add<std::uint16_t>(0);
    text.add(encoding_flags);
    text.add_text("", 16);
    text.add<std::uint8_t>(1);
    text.add<std::uint8_t>(4);
    text.add_text("EXTRACTION", 32);
    text.add_text("roomscribe", 32);
    // No date: the same cloud gives the same file.
    text.add_text("", 4);
    text.add(static_cast<std::uint16_t>(header_bytes));
    text.add(static_cast<std::uint32_t>(header_bytes + extra.size()));
    text.add<std::uint32_t>(extra.empty() ? 0 : 1);
    text.add(static_cast<std::uint8_t>(layout.point_format));
    text.add(static_cast<std::uint16_t>(layout.record_bytes));
    text.add_text("", 24);  // counts of 32 bits, which formats 6 and above do not use
    for (const double scale : steps.scale)
        text.add(scale);
    for (const double offset : cloud.global_shift)
        text.add(offset);
    for (Eigen::Index k = 0; k < 3; ++k) {
        text.add(steps.max[k] + cloud.global_shift[k]);
        text.add(steps.min[k] + cloud.global_shift[k]);
    }
    text.add_text("", 20);  // no waveforms, no records behind the points
    text.add(static_cast<std::uint64_t>(cloud.size()));
    text.add(static_cast<std::uint64_t>(cloud.size()));  // first returns
    text.add_text("", 14 * sizeof(std::uint64_t));
    return text.bytes();
}

void store_uint16(std::byte* target, std::uint16_t value) {
    if constexpr (std::endian::native == std::endian::big) value = swap_bytes(value);
    std::memcpy(target, &value, sizeof(value));
}

void fill_record(std::byte* record, const PointCloud& cloud, std::size_t i, const Layout& layout,
                 const Steps& steps, const IntensityRange& intensity) {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        auto count = static_cast<std::int32_t>(
            std::round(static_cast<double>(cloud.positions[i][axis]) / steps.scale[axis]));
        if constexpr (std::endian::native == std::endian::big) count = swap_bytes(count);
        std::memcpy(record + 4 * k, &count, sizeof(count));
    }
    if (!cloud.intensities.empty() && std::isfinite(cloud.intensities[i])) {
        const double value = cloud.intensities[i] * intensity.scale + intensity.offset;
        const double inside = std::clamp(std::round(value), 0.0, largest_uint16);
        store_uint16(record + 12, static_cast<std::uint16_t>(inside));
    }
    record[14] = only_return;
    for (std::size_t k = 0; k < 3 && !cloud.colors.empty(); ++k) {
        // 255 becomes 65535, as the specification asks.
        store_uint16(record + layout.color_offset + 2 * k,
                     static_cast<std::uint16_t>(cloud.colors[i][k] * 257));
    }
    for (const Placed& placed : layout.copied) {
        const FieldColumn& column = *placed.column;
        std::memcpy(record + placed.offset, column.first + i * column.stride, placed.bytes);
        if constexpr (std::endian::native == std::endian::big) {
            std::reverse(record + placed.offset, record + placed.offset + placed.bytes);
        }
    }
}

void write_points(const std::filesystem::path& path, const PointCloud& cloud,
                  const Context& context) {
    const PointColumns points(cloud, FieldStyle::las);
    const Layout layout = make_layout(cloud, points);
    const Steps steps = choose_steps(cloud);
    const IntensityRange intensity = intensity_range(cloud.intensities);
    const std::string extra = extra_bytes_text(layout.extra);
    AtomicFile file(path, "LAS");
    file.write(header_text(cloud, layout, steps, extra));
    file.write(extra);
    std::vector<std::byte> records;
    for (std::size_t first = 0; first < cloud.size(); first += points_per_chunk) {
        context.throw_if_cancelled();
        const std::size_t count = std::min(points_per_chunk, cloud.size() - first);
        records.assign(count * layout.record_bytes, std::byte{0});
        for (std::size_t i = 0; i < count; ++i) {
            fill_record(records.data() + i * layout.record_bytes, cloud, first + i, layout, steps,
                        intensity);
        }
        file.write(records);
    }
    file.commit();
}

}  // namespace

void write_las(const std::filesystem::path& path, const PointCloud& cloud, const Context& context) {
    check_cloud(cloud);
    const std::vector<std::uint32_t> finite = finite_points(cloud);
    if (finite.size() == cloud.size()) {
        write_points(path, cloud, context);
    } else {
        write_points(path, select_points(cloud, finite), context);
    }
}

}  // namespace roomscribe
