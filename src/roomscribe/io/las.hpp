// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// ASPRS LAS 1.0 to 1.4, point formats 0 to 10: read_scan and write_point_cloud for one format.
/// Coordinates are integers in steps of a scale from an offset; both are applied in double. Colours
/// of 16 bits become 8: all are divided by 256 if one is above 255 (some writers put 8 bits there).
/// Classification (without its flags in formats 0 to 5), angle, user data, source, time, near
/// infrared and extra bytes are channels, but for those that are zero everywhere (the class
/// always is one); return counts and waveforms are dropped.
/// LAZ, which is compressed, is refused with a word on how to open it.
FileContents read_las(const std::filesystem::path& path, PointsAs as, const Context& context);

/// Writes LAS 1.4, point format 7, or 6 without colours, in steps of 0.1 mm (coarser only for
/// clouds more than 400 km wide) from the global shift. Channels with a place in the format go
/// there, the others and normals become extra bytes. LAS has no place for points without
/// coordinates: they are left out. Intensities that are no integers from 0 to 65535 are stretched
/// over these. Every point is the only return of its pulse.
void write_las(const std::filesystem::path& path, const PointCloud& cloud, const Context& context);

}  // namespace roomscribe
