// SPDX-License-Identifier: MIT
#include "roomscribe/io/poses_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/uos.hpp"

namespace roomscribe {
namespace {

constexpr double rotation_tolerance = 1e-3;
constexpr std::string_view cure =
    "write 12 numbers a line (KITTI), 8 (TUM), four lines of 4 (matrix), or 6 in a .pose file "
    "(UOS)";

bool is_pose_file(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".pose";
}

/// The numbers of the next line; empty for a blank line or a comment.
std::vector<double> read_numbers(ByteReader& reader) {
    std::vector<double> numbers;
    for (const std::string_view word : split_words(reader.read_line())) {
        if (word.starts_with('#')) break;
        const std::optional<double> number = parse_real(word);
        if (!number) reader.fail_at_line(fmt::format("{} is no number", quote_text(word)), cure);
        numbers.push_back(*number);
    }
    return numbers;
}

Transform checked_pose(const ByteReader& reader, const Eigen::Matrix3d& rotation,
                       const Eigen::Vector3d& position) {
    const bool orthonormal = (rotation * rotation.transpose()).isIdentity(rotation_tolerance);
    if (!position.allFinite() || !orthonormal || rotation.determinant() < 0.0) {
        reader.fail_at_line("the pose is no rotation and finite position", cure);
    }
    Transform pose = Transform::Identity();
    pose.linear() = nearest_rotation(rotation);
    pose.translation() = position;
    return pose;
}

/// Of 12 numbers, or 16 with the last row of a 4x4 matrix.
std::optional<Transform> matrix_pose(const ByteReader& reader, const std::vector<double>& numbers) {
    const std::span<const double> upper = std::span(numbers).first(12);
    if (std::none_of(upper.begin(), upper.end(), [](double value) { return std::isfinite(value); }))
        return std::nullopt;
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(upper.data());
    if (numbers.size() == 16 &&
        Eigen::Map<const Eigen::RowVector4d>(numbers.data() + 12) != Eigen::RowVector4d(0, 0, 0, 1))
        reader.fail_at_line("the matrix does not end with 0 0 0 1", cure);
    return checked_pose(reader, matrix.leftCols<3>(), matrix.col(3));
}

Transform tum_pose(const ByteReader& reader, const std::vector<double>& row) {
    const Eigen::Quaterniond rotation(row[7], row[4], row[5], row[6]);
    if (!(std::abs(rotation.norm() - 1.0) < rotation_tolerance)) {
        reader.fail_at_line("the quaternion is not of length 1", cure);
    }
    return checked_pose(reader, rotation.normalized().toRotationMatrix(),
                        Eigen::Vector3d(row[1], row[2], row[3]));
}

Transform read_uos_pose(ByteReader& reader) {
    std::vector<double> numbers;
    while (!reader.at_end()) {
        const std::vector<double> line = read_numbers(reader);
        numbers.insert(numbers.end(), line.begin(), line.end());
    }
    std::array<double, 6> pose{};
    const bool finite = std::all_of(numbers.begin(), numbers.end(),
                                    [](double value) { return std::isfinite(value); });
    if (numbers.size() != pose.size() || !finite) {
        reader.fail_at_line(fmt::format("{} numbers are no pose", numbers.size()), cure);
    }
    std::copy(numbers.begin(), numbers.end(), pose.begin());
    return transform_from_uos(pose);
}

}  // namespace

std::vector<std::optional<Transform>> read_poses(const std::filesystem::path& path,
                                                 const Context& context) {
    const MappedFile file(path, "poses");
    ByteReader reader(file, "poses");
    if (is_pose_file(path)) return {read_uos_pose(reader)};
    std::vector<std::optional<Transform>> poses;
    std::vector<double> matrix;
    std::size_t row_length = 0;
    while (!reader.at_end()) {
        context.throw_if_cancelled();
        const std::vector<double> row = read_numbers(reader);
        if (row.empty()) continue;
        if (row_length == 0) row_length = row.size();
        const bool is_known = row_length == 12 || row_length == 8 || row_length == 4;
        if (row.size() != row_length || !is_known) {
            reader.fail_at_line(fmt::format("{} numbers are no pose", row.size()), cure);
        }
        if (row_length == 8) {
            poses.emplace_back(tum_pose(reader, row));
            continue;
        }
        matrix.insert(matrix.end(), row.begin(), row.end());
        const std::size_t length = row_length == 4 ? 16 : 12;
        if (matrix.size() < length) continue;
        poses.push_back(matrix_pose(reader, matrix));
        matrix.clear();
    }
    if (!matrix.empty()) reader.fail_at_line("the last matrix is cut off", cure);
    if (poses.empty()) reader.fail_at_line("there are no poses", cure);
    return poses;
}

void write_poses(const std::filesystem::path& path,
                 std::span<const std::optional<Transform>> map_from_scan) {
    std::string text;
    auto out = std::back_inserter(text);
    if (is_pose_file(path)) {
        if (map_from_scan.size() != 1 || !map_from_scan[0]) {
            throw InvalidArgument("map_from_scan", fmt::format("{} poses", map_from_scan.size()),
                                  "one pose, which is what a .pose file holds");
        }
        const std::array<double, 6> pose = uos_from_transform(*map_from_scan[0]);
        fmt::format_to(out, "{} {} {}\n{} {} {}\n", pose[0], pose[1], pose[2], pose[3], pose[4],
                       pose[5]);
        return write_file(path, "poses", text);
    }
    for (const std::optional<Transform>& pose : map_from_scan) {
        for (Eigen::Index row = 0; row < 3; ++row) {
            for (Eigen::Index column = 0; column < 4; ++column) {
                if (row + column > 0) text += ' ';
                if (pose) {
                    fmt::format_to(out, "{}", (*pose)(row, column));
                } else {
                    text += "nan";
                }
            }
        }
        text += '\n';
    }
    write_file(path, "poses", text);
}

}  // namespace roomscribe
