// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// Reads one pose per scan, scan -> map, in file order. The format is told by the numbers:
/// - 12 a line: KITTI, row-major 3x4 (roomscribe's own poses.txt). A pose without a finite number
///   is a scan without a place and gives an empty entry.
/// - 4 a line: 4x4 matrices of four lines each, as 7-Scenes and 3DMatch have one for each frame.
/// - 8 a line: TUM, time x y z qx qy qz qw; the time is dropped.
/// - 6 in the whole file, named .pose: UOS, one pose, see uos.hpp for the frames.
/// Empty lines and lines that begin with # are skipped. A rotation that is off by rounding is made
/// orthonormal. Throws IoError for a file that cannot be read, has no poses or other counts of
/// numbers, an infinite or partly missing pose, or a matrix that is no rotation (by more than
/// 1e-3).
std::vector<std::optional<Transform>> read_poses(const std::filesystem::path& path,
                                                 const Context& context = {});

/// Writes poses in the KITTI convention, with all the digits of a double, an empty one as a line of
/// nan; or as UOS if the file is named .pose. Throws InvalidArgument if that is not exactly one
/// pose, and IoError if the file cannot be written. The file appears whole or not at all.
void write_poses(const std::filesystem::path& path,
                 std::span<const std::optional<Transform>> map_from_scan);

}  // namespace roomscribe
