// SPDX-License-Identifier: MIT
#include "roomscribe/io/uos.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_rows.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"

namespace roomscribe {
namespace {

constexpr double centimetres = 100.0;
constexpr std::size_t max_columns = 64;
constexpr std::size_t rows_per_chunk = 1U << 12U;

/// M: roomscribe's axes from 3DTK's.
Eigen::Matrix3d axes_from_uos() {
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, 1, 0;
    return axes;
}

void skip_comments(ByteReader& reader) {
    while (reader.remaining_text().starts_with('#'))
        reader.read_line();
}

/// The columns that the first line with anything in it has.
std::size_t count_columns(ByteReader reader) {
    std::vector<std::string_view> words;
    while (words.empty() && !reader.at_end())
        words = split_words(reader.read_line());
    if (words.size() < 3 || words.size() > max_columns) {
        reader.fail_at_line(fmt::format("{} columns are no point", words.size()),
                            "write x y z, in centimetres, in each line");
    }
    return words.size();
}

std::vector<Field> uos_fields(std::size_t num_columns) {
    std::vector<Field> fields = {{"x", ScalarType::float64, 1},
                                 {"y", ScalarType::float64, 1},
                                 {"z", ScalarType::float64, 1}};
    if (num_columns == 4) fields.push_back({"intensity", ScalarType::float64, 1});
    for (std::size_t i = 4; i <= num_columns && num_columns > 4; ++i) {
        fields.push_back({fmt::format("column_{}", i), ScalarType::float64, 1});
    }
    return fields;
}

std::size_t count_lines_with_content(ByteReader reader) {
    return count_rows(take_row_blocks(reader, std::numeric_limits<std::size_t>::max()));
}

void convert_axes(double* point) {
    const Eigen::Vector3d uos(point[0], point[1], point[2]);
    Eigen::Map<Eigen::Vector3d> converted(point);
    converted = Eigen::Vector3d(uos.z(), -uos.x(), uos.y()) / centimetres;
}

}  // namespace

FileContents read_uos(const std::filesystem::path& path, PointsAs as, const Context& context) {
    const MappedFile file(path, "UOS");
    ByteReader reader(file, "UOS");
    skip_comments(reader);
    const std::size_t num_columns = count_columns(reader);
    const std::size_t num_points = count_lines_with_content(reader);
    reader.require_backed(num_points, 2 * num_columns - 1, "points");

    FileContents contents{{}, "UOS", "ascii", uos_fields(num_columns), {}};
    PointDecoder decoder(contents.fields, num_points, as);
    const std::vector<TextColumn> columns(num_columns, {ScalarType::float64});
    TextTable table(reader, columns);
    std::vector<double> rows(std::min(rows_per_chunk, num_points) * num_columns);
    const auto sources =
        record_sources(contents.fields, reinterpret_cast<const std::byte*>(rows.data()));
    for (std::size_t first = 0; first < num_points; first += rows_per_chunk) {
        context.throw_if_cancelled();
        const std::size_t count = std::min(rows_per_chunk, num_points - first);
        for (std::size_t i = 0; i < count; ++i) {
            double* const row = rows.data() + i * num_columns;
            table.read_row(reinterpret_cast<std::byte*>(row));
            convert_axes(row);
        }
        decoder.decode(sources, first, count, std::endian::native, context);
    }
    decoder.finish(contents, std::nullopt, std::nullopt);
    return contents;
}

void write_uos(const std::filesystem::path& path, const PointCloud& cloud, const Context& context) {
    if (!cloud.intensities.empty() && cloud.intensities.size() != cloud.size()) {
        throw InvalidArgument("intensities", fmt::format("{} values", cloud.intensities.size()),
                              fmt::format("empty or one per point ({})", cloud.size()));
    }
    AtomicFile file(path, "UOS");
    std::string text;
    // Far coordinates are doubles in the file and need the digits of one.
    const int digits = cloud.global_shift.isZero(0.0) ? 9 : 16;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3d point =
            (cloud.positions[i].cast<double>() + cloud.global_shift) * centimetres;
        fmt::format_to(std::back_inserter(text), "{:.{}g} {:.{}g} {:.{}g}", -point.y(), digits,
                       point.z(), digits, point.x(), digits);
        if (!cloud.intensities.empty()) {
            fmt::format_to(std::back_inserter(text), " {}", cloud.intensities[i]);
        }
        text += '\n';
        if (text.size() > (1U << 20U)) {
            context.throw_if_cancelled();
            file.write(text);
            text.clear();
        }
    }
    file.write(text);
    file.commit();
}

Transform transform_from_uos(const std::array<double, 6>& pose) {
    const Eigen::Matrix3d rotation =
        (Eigen::AngleAxisd(radians(pose[3]), Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(radians(pose[4]), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(radians(pose[5]), Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    const Eigen::Matrix3d axes = axes_from_uos();
    Transform transform = Transform::Identity();
    transform.linear() = axes * rotation * axes.transpose();
    transform.translation() = axes * Eigen::Vector3d(pose[0], pose[1], pose[2]) / centimetres;
    return transform;
}

std::array<double, 6> uos_from_transform(const Transform& transform) {
    const Eigen::Matrix3d axes = axes_from_uos();
    const Eigen::Matrix3d rotation = axes.transpose() * transform.linear() * axes;
    const Eigen::Vector3d position = axes.transpose() * transform.translation() * centimetres;
    const double cosine = std::hypot(rotation(0, 0), rotation(0, 1));
    double a = std::atan2(-rotation(1, 2), rotation(2, 2));
    const double b = std::atan2(rotation(0, 2), cosine);
    double c = std::atan2(-rotation(0, 1), rotation(0, 0));
    if (cosine < 1e-9) {
        // Looking straight along x, the first and third angle turn about one axis.
        a = 0.0;
        c = std::atan2(rotation(1, 0), rotation(1, 1));
    }
    return {position.x(), position.y(), position.z(), degrees(a), degrees(b), degrees(c)};
}

}  // namespace roomscribe
