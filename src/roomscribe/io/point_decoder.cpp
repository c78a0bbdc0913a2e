// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <type_traits>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/global_shift.hpp"
#include "roomscribe/io/scalar_dispatch.hpp"
#include "roomscribe/io/strided_copy.hpp"

namespace roomscribe {

/// A run of points whose sources lie in memory.
struct SourceRun {
    std::span<const FieldSource> sources;
    std::size_t source_offset;  ///< of the first point in the sources, in points
    std::size_t first;          ///< number of that point in the cloud
    std::size_t count;
    bool swap;

    FieldSource source(std::size_t field) const {
        const FieldSource whole = sources[field];
        return {whole.first + source_offset * whole.stride, whole.stride};
    }
};

namespace {

/// Records of so many points stay in the cache while one field after another is taken from them.
constexpr std::size_t points_per_chunk = 1U << 12U;
/// No map grid reaches further: a coordinate beyond is rubbish that must not decide the shift.
constexpr double largest_map_coordinate = 1e8;

using Names = std::initializer_list<std::string_view>;
using Accepts = bool (*)(ScalarType);

bool any_type(ScalarType) {
    return true;
}
bool is_real(ScalarType type) {
    return type == ScalarType::float32 || type == ScalarType::float64;
}
bool is_byte(ScalarType type) {
    return type == ScalarType::uint8;
}
bool has_four_bytes(ScalarType type) {
    return size_of(type) == 4;
}
/// Types whose values float32 may not hold.
bool is_wide(ScalarType type) {
    return size_of(type) >= 4 && type != ScalarType::float32;
}

std::optional<std::size_t> find_field(std::span<const Field> fields, Names names, Accepts accepts) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const bool named = std::find(names.begin(), names.end(), fields[i].name) != names.end();
        if (named && fields[i].count == 1 && accepts(fields[i].type)) return i;
    }
    return std::nullopt;
}

/// Converts one value per point to float32: value * scale + offset.
void convert_column(float* target, std::size_t target_stride, FieldSource source, ScalarType type,
                    bool swap, double scale, double offset, std::size_t count) {
    with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
        auto* bytes = reinterpret_cast<std::byte*>(target);
        for (std::size_t i = 0; i < count; ++i) {
            Value value;
            std::memcpy(&value, source.first + i * source.stride, sizeof(Value));
            if (swap) value = swap_bytes(value);
            const auto converted = static_cast<float>(static_cast<double>(value) * scale + offset);
            std::memcpy(bytes + i * target_stride, &converted, sizeof(float));
        }
    });
}

/// The same for three values of one type per point, in one pass over the records.
void convert_triple(Eigen::Vector3f* target, const SourceRun& run,
                    const std::array<std::size_t, 3>& fields, ScalarType type,
                    const Eigen::Vector3d& scale, const Eigen::Vector3d& offset) {
    const std::array<FieldSource, 3> sources{run.source(fields[0]), run.source(fields[1]),
                                             run.source(fields[2])};
    with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
        const auto convert = [&](auto swapped) {
            for (std::size_t i = 0; i < run.count; ++i) {
                std::array<double, 3> point{};
                for (std::size_t k = 0; k < 3; ++k) {
                    Value value;
                    std::memcpy(&value, sources[k].first + i * sources[k].stride, sizeof(Value));
                    if constexpr (decltype(swapped)::value) value = swap_bytes(value);
                    point[k] = static_cast<double>(value);
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto axis = static_cast<Eigen::Index>(k);
                    target[i][axis] = static_cast<float>(point[k] * scale[axis] + offset[axis]);
                }
            }
        };
        if (run.swap) {
            convert(std::true_type());
        } else {
            convert(std::false_type());
        }
    });
}

/// Three values per point, of a type that is kept: at once where they lie side by side.
void copy_triple(std::byte* target, const SourceRun& run, const std::array<std::size_t, 3>& fields,
                 std::size_t size) {
    const std::size_t stride = 3 * size;
    const FieldSource first = run.source(fields[0]);
    const FieldSource second = run.source(fields[1]);
    const FieldSource third = run.source(fields[2]);
    const bool adjacent = first.stride == second.stride && first.stride == third.stride &&
                          second.first == first.first + size && third.first == second.first + size;
    if (adjacent) {
        copy_values(target, stride, first.first, first.stride, size, 3, run.count, run.swap);
        return;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const FieldSource source = run.source(fields[k]);
        copy_values(target + k * size, stride, source.first, source.stride, size, 1, run.count,
                    run.swap);
    }
}

/// Three values per point to float32, value * scale + offset; float32 keeps its bits.
void decode_vectors(Eigen::Vector3f* target, const SourceRun& run,
                    const std::array<std::size_t, 3>& fields, std::span<const Field> all,
                    const Eigen::Vector3d& scale, const Eigen::Vector3d& offset) {
    const bool exact = std::all_of(fields.begin(), fields.end(), [&](std::size_t field) {
        return all[field].type == ScalarType::float32;
    });
    if (exact) {
        copy_triple(reinterpret_cast<std::byte*>(target), run, fields, sizeof(float));
        return;
    }
    const ScalarType type = all[fields[0]].type;
    if (all[fields[1]].type == type && all[fields[2]].type == type) {
        convert_triple(target, run, fields, type, scale, offset);
        return;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        convert_column(target->data() + k, sizeof(Eigen::Vector3f), run.source(fields[k]),
                       all[fields[k]].type, run.swap, scale[axis], offset[axis], run.count);
    }
}

}  // namespace

double load_as_double(const std::byte* bytes, ScalarType type, bool swap) {
    return with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
        Value value;
        std::memcpy(&value, bytes, sizeof(Value));
        return static_cast<double>(swap ? swap_bytes(value) : value);
    });
}

std::size_t record_bytes(std::span<const Field> fields) {
    std::size_t bytes = 0;
    for (const Field& field : fields)
        bytes += field.bytes();
    return bytes;
}

std::vector<FieldSource> record_sources(std::span<const Field> fields, const std::byte* records) {
    const std::size_t stride = record_bytes(fields);
    std::vector<FieldSource> sources;
    for (const Field& field : fields) {
        sources.push_back({records, stride});
        records += field.bytes();
    }
    return sources;
}

bool PointDecoder::has_positions(std::span<const Field> fields) {
    return find_field(fields, {"x"}, any_type) && find_field(fields, {"y"}, any_type) &&
           find_field(fields, {"z"}, any_type);
}

PointDecoder::PointDecoder(std::span<const Field> fields, std::size_t num_points, PointsAs as)
    : fields_(fields.begin(), fields.end()), num_points_(num_points), as_(as) {
    std::vector<bool> taken(fields.size(), false);
    const auto find_triple = [&](Names first, Names second, Names third,
                                 Accepts accepts) -> std::optional<Triple> {
        const auto a = find_field(fields_, first, accepts);
        const auto b = find_field(fields_, second, accepts);
        const auto c = find_field(fields_, third, accepts);
        if (!a || !b || !c) return std::nullopt;
        taken[*a] = taken[*b] = taken[*c] = true;
        return Triple{{*a, *b, *c}};
    };
    position_ = find_triple({"x"}, {"y"}, {"z"}, any_type).value();
    normal_ = find_triple({"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}, is_real);
    color_ = find_triple({"red"}, {"green"}, {"blue"}, is_byte);
    if (!color_) packed_color_ = find_field(fields_, {"rgb", "rgba"}, has_four_bytes);
    if (packed_color_) taken[*packed_color_] = true;
    intensity_ =
        find_field(fields_, {"intensity", "scalar_Intensity", "scalar_intensity"}, any_type);
    if (intensity_) taken[*intensity_] = true;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
        if (!taken[i] && fields_[i].name != "_") channel_fields_.push_back(i);
    }
    if (as_ == PointsAs::cloud) make_room();
}

void PointDecoder::make_room() {
    cloud_.positions.resize(num_points_);
    if (normal_) cloud_.normals.resize(num_points_);
    if (color_ || packed_color_) cloud_.colors.resize(num_points_);
    if (intensity_) cloud_.intensities.resize(num_points_);
    for (const std::size_t i : channel_fields_) {
        const Field& field = fields_[i];
        Channel channel{field.name, field.type, field.count, {}};
        channel.values.resize(num_points_ * field.bytes());
        cloud_.channels.push_back(std::move(channel));
    }
}

void PointDecoder::quantize_positions(const Eigen::Vector3d& scale, const Eigen::Vector3d& offset) {
    scale_ = scale;
    offset_ = offset;
}

void PointDecoder::choose_global_shift(const SourceRun& run) {
    for (std::size_t i = 0; i < run.count && !shift_known_; ++i) {
        Eigen::Vector3d point;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t field = position_.fields[k];
            const FieldSource source = run.source(field);
            point[static_cast<Eigen::Index>(k)] =
                load_as_double(source.first + i * source.stride, fields_[field].type, run.swap);
        }
        point = point.cwiseProduct(scale_) + offset_;
        if (!(point.cwiseAbs().maxCoeff() < largest_map_coordinate)) continue;
        shift_known_ = true;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!is_wide(fields_[position_.fields[k]].type)) continue;
            const auto axis = static_cast<Eigen::Index>(k);
            cloud_.global_shift[axis] = global_shift_of(point[axis]);
        }
    }
}

void PointDecoder::decode(std::span<const FieldSource> sources, std::size_t first,
                          std::size_t count, std::endian order, const Context& context) {
    const bool swap = order != std::endian::native;
    const bool wide = std::any_of(position_.fields.begin(), position_.fields.end(),
                                  [&](std::size_t field) { return is_wide(fields_[field].type); });
    if (wide && !shift_known_) choose_global_shift({sources, 0, first, count, swap});
    const auto run = [&](std::size_t begin, std::size_t end) {
        return SourceRun{sources, begin, first + begin, end - begin, swap};
    };
    if (as_ == PointsAs::cloud) {
        parallel_for(context, count, points_per_chunk,
                     [&](std::size_t begin, std::size_t end) { decode_run(run(begin, end)); });
        return;
    }
    const PointSummary added = parallel_reduce(
        context, count, points_per_chunk, PointSummary(),
        [&](std::size_t begin, std::size_t end) { return summarize_run(run(begin, end)); }, joined);
    summary_ = joined(std::move(summary_), added);
}

void PointDecoder::decode_mapped(std::span<const std::byte> records, std::endian order,
                                 const Context& context) {
    const std::size_t record = record_bytes(fields_);
    const std::size_t num_points = records.size() / record;
    const std::size_t points_per_run = std::max<std::size_t>(1, bytes_let_go_at_once / record);
    for (std::size_t first = 0; first < num_points; first += points_per_run) {
        const std::size_t count = std::min(points_per_run, num_points - first);
        const auto run = records.subspan(first * record, count * record);
        decode(record_sources(fields_, run.data()), first, count, order, context);
        let_go(run);
    }
}

void PointDecoder::decode_positions(Eigen::Vector3f* target, const SourceRun& run) const {
    decode_vectors(target, run, position_.fields, fields_, scale_, offset_ - cloud_.global_shift);
}

PointSummary PointDecoder::summarize_run(const SourceRun& run) const {
    std::vector<Eigen::Vector3f> positions(run.count);
    decode_positions(positions.data(), run);
    return summarize_points(positions, run.first, num_points_);
}

void PointDecoder::decode_run(const SourceRun& run) {
    decode_positions(cloud_.positions.data() + run.first, run);
    if (normal_) {
        decode_vectors(cloud_.normals.data() + run.first, run, normal_->fields, fields_,
                       Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero());
    }
    if (color_) {
        copy_triple(reinterpret_cast<std::byte*>(cloud_.colors.data() + run.first), run,
                    color_->fields, 1);
    }
    if (packed_color_) {
        const FieldSource source = run.source(*packed_color_);
        for (std::size_t i = 0; i < run.count; ++i) {
            std::uint32_t packed = 0;
            std::memcpy(&packed, source.first + i * source.stride, sizeof(packed));
            if (run.swap) packed = swap_bytes(packed);
            cloud_.colors[run.first + i] = {static_cast<std::uint8_t>(packed >> 16U),
                                            static_cast<std::uint8_t>(packed >> 8U),
                                            static_cast<std::uint8_t>(packed)};
        }
    }
    if (intensity_) {
        const ScalarType type = fields_[*intensity_].type;
        const FieldSource source = run.source(*intensity_);
        float* target = cloud_.intensities.data() + run.first;
        if (type == ScalarType::float32) {
            copy_values(reinterpret_cast<std::byte*>(target), sizeof(float), source.first,
                        source.stride, sizeof(float), 1, run.count, run.swap);
        } else {
            convert_column(target, sizeof(float), source, type, run.swap, 1.0, 0.0, run.count);
        }
    }
    for (std::size_t i = 0; i < channel_fields_.size(); ++i) {
        Channel& channel = cloud_.channels[i];
        const FieldSource source = run.source(channel_fields_[i]);
        const std::size_t stride = channel.bytes_per_point();
        copy_values(channel.values.data() + run.first * stride, stride, source.first, source.stride,
                    size_of(channel.type), channel.count, run.count, run.swap);
    }
}

void PointDecoder::finish(FileContents& contents, const std::optional<Transform>& file_sensor_pose,
                          const std::optional<ScanGrid>& grid) {
    contents.cloud = std::move(cloud_);
    contents.cloud.grid = grid;
    contents.cloud.sensor_pose = file_sensor_pose;
    if (file_sensor_pose) contents.cloud.sensor_pose->translation() -= contents.cloud.global_shift;
    contents.summary = std::move(summary_);
}

}  // namespace roomscribe
