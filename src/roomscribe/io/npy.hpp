// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// Reads a one-dimensional NumPy array (.npy, format 1 or 2, little endian) whose element type is
/// exactly Value: std::uint8_t, std::uint16_t or std::int32_t. Throws IoError if the file cannot be
/// read, is no .npy file, is cut off, or holds another type, byte order or number of dimensions.
/// Never allocates more than the file's real size can back.
template <typename Value>
std::vector<Value> read_npy(const std::filesystem::path& path);

/// Writes a one-dimensional array of the same types, format 1. The file appears whole or not at
/// all. Throws IoError if it cannot be written.
template <typename Value>
void write_npy(const std::filesystem::path& path, std::span<const Value> values);

/// Reads points: a two-dimensional array of float32 or float64, of either order, with 3 to 6
/// columns, which are told by their numbers as those of text are (guessed_columns.hpp). Throws
/// IoError as read_npy does.
FileContents read_npy_points(const std::filesystem::path& path, PointsAs as,
                             const Context& context);

}  // namespace roomscribe
