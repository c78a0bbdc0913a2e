// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// Leica's PTX: any number of scans, each with its grid, its pose and one line per ray: x y z
/// intensity, and perhaps r g b, in the scanner's frame. The grid stands in the file column by
/// column; a column of the file, one sweep of the scanner, is a row of ScanGrid. A ray without
/// return, 0 0 0 in the file, is NaN. The 4x4 matrix of a scan multiplies row vectors from the
/// right (its last row is the translation); the four lines before it, which say the same again, are
/// not used.
std::vector<FileContents> read_ptx(const std::filesystem::path& path, PointsAs as,
                                   const Context& context);

}  // namespace roomscribe
