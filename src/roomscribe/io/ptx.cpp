// SPDX-License-Identifier: MIT
#include "roomscribe/io/ptx.hpp"

#include <cmath>

#include <fmt/format.h>

#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/row_fields.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view cure = "the file is damaged or cut off: export it again";
constexpr double rotation_tolerance = 1e-3;

std::vector<std::string_view> next_words(ByteReader& reader) {
    std::vector<std::string_view> words;
    while (words.empty())
        words = split_words(reader.read_line());
    return words;
}

std::uint64_t read_count(ByteReader& reader, std::string_view what) {
    const auto words = next_words(reader);
    const auto count = words.size() == 1 ? parse_count(words[0]) : std::nullopt;
    if (!count || *count == 0) {
        reader.fail_at_line(fmt::format("there is no number of {}", what), cure);
    }
    return *count;
}

Eigen::Vector4d read_numbers(ByteReader& reader, Eigen::Index count) {
    const auto words = next_words(reader);
    Eigen::Vector4d numbers = Eigen::Vector4d::Zero();
    const bool fits = words.size() == static_cast<std::size_t>(count);
    for (Eigen::Index i = 0; i < count && fits; ++i) {
        numbers[i] = parse_real(words[static_cast<std::size_t>(i)]).value_or(std::nan(""));
    }
    if (!fits || !numbers.allFinite()) {
        reader.fail_at_line(fmt::format("there are not {} numbers", count), cure);
    }
    return numbers;
}

Transform read_pose(ByteReader& reader) {
    // The scanner's place and axes.
    for (int i = 0; i < 4; ++i)
        read_numbers(reader, 3);
    Eigen::Matrix4d transposed;
    for (Eigen::Index i = 0; i < 4; ++i)
        transposed.row(i) = read_numbers(reader, 4).transpose();
    const Eigen::Matrix4d matrix = transposed.transpose();
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    if (!(rotation * rotation.transpose()).isIdentity(rotation_tolerance) ||
        rotation.determinant() < 0.0) {
        reader.fail_at_line("the matrix of the scan is no rotation and translation",
                            "export the scan again without scale");
    }
    Transform pose = Transform::Identity();
    pose.linear() = nearest_rotation(rotation);
    pose.translation() = matrix.topRightCorner<3, 1>();
    return pose;
}

std::size_t count_columns(ByteReader reader) {
    const std::size_t count = next_words(reader).size();
    if (count != 3 && count != 4 && count != 7) {
        reader.fail_at_line(fmt::format("{} columns are no point", count),
                            "PTX has x y z intensity, and perhaps r g b, in each line");
    }
    return count;
}

bool holds_more(const ByteReader& reader) {
    return reader.remaining_text().find_first_not_of(" \t\r\n") != std::string_view::npos;
}

FileContents read_one(ByteReader& reader, PointsAs as, const Context& context) {
    const std::uint64_t num_columns = read_count(reader, "columns");
    const std::uint64_t num_rows = read_count(reader, "rows");
    // A line of a point has at least 5 bytes, and the last may lack its end.
    reader.require_backed(num_columns, 6, "columns");
    reader.require_backed(num_rows, 6, "rows");
    const std::uint64_t num_points = num_columns * num_rows;
    FileContents contents;
    contents.map_from_scan = read_pose(reader);
    reader.require_backed(num_points, 5, "points");

    const RowFormat format{' ', count_columns(reader)};
    std::vector<std::string> names = {"x", "y", "z", "intensity", "red", "green", "blue"};
    names.resize(format.num_columns);
    const std::vector<RowBlock> blocks =
        take_row_blocks(reader, static_cast<std::size_t>(num_points));
    contents.format = "PTX";
    contents.encoding = "ascii";
    contents.fields = row_fields(names);
    decode_rows(reader, blocks, format, 1.0, true, as, contents, context);
    const std::size_t num_rows_found = count_rows(blocks);
    if (num_rows_found < num_points) {
        reader.fail_at_byte(fmt::format("there are {} of {} points", num_rows_found, num_points),
                            cure);
    }
    if (num_columns > 1 && num_rows > 1) contents.cloud.grid = ScanGrid{num_columns, num_rows};
    return contents;
}

}  // namespace

std::vector<FileContents> read_ptx(const std::filesystem::path& path, PointsAs as,
                                   const Context& context) {
    const MappedFile file(path, "PTX");
    ByteReader reader(file, "PTX");
    std::vector<FileContents> scans;
    while (scans.empty() || holds_more(reader)) {
        context.throw_if_cancelled();
        scans.push_back(read_one(reader, as, context));
    }
    return scans;
}

}  // namespace roomscribe
