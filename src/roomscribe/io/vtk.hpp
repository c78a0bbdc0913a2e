// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// The POINTS of a legacy VTK file, POLYDATA or UNSTRUCTURED_GRID, ASCII or BINARY (big endian).
/// What follows them (cells, point data) is not read.
/// Source: "VTK File Formats", simple legacy formats.
FileContents read_vtk(const std::filesystem::path& path, PointsAs as, const Context& context);

}  // namespace roomscribe
