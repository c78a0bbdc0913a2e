// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/point_cloud_io.hpp"

namespace roomscribe {

/// ASTM E2807 (E57), all scans of the file. The checksum of every page is tested first. Points are
/// cartesian, else spherical ones made cartesian; those marked as invalid are NaN. Colours are
/// scaled from their limits to 0 to 255. Row and column index give the grid where they count all
/// cells one after another (column by column, a column is a row of ScanGrid), and are channels in
/// any case, as is everything else. A scan with a pose is in the scanner's frame; without one, in
/// the file's, and nothing is known of its scanner. Images are not read.
/// Source: ASTM E2807-11; libE57Format's description of the packets.
std::vector<FileContents> read_e57(const std::filesystem::path& path, PointsAs as,
                                   const Context& context);

/// Writes scans with their poses. Numbers keep their types and bits: float32 as single, integers
/// packed into the bits of their type (those of 64 bits are read back as float64). Points without
/// coordinates are marked as invalid. Channels stand in a namespace of their own. The sensor pose
/// is dropped.
void write_e57(const std::filesystem::path& path, std::span<const StoredScan> scans,
               const Context& context);

inline constexpr const char* e57_channel_prefix = "roomscribe";
inline constexpr const char* e57_normal_prefix = "nor";

}  // namespace roomscribe
