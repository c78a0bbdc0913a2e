// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// Ranges of a planar scanner on a tilting unit, as they come from the wire (the paper's SICK LMS
/// on its tilting unit, section 3.1). Text; # begins a comment. First the geometry, in any order:
///
///     unit mm                  of the ranges: m, cm or mm (default m)
///     start -90                bearing of the first ray in the plane of the scanner, degrees, left
///                              of straight ahead positive (default: the rays lie symmetrically)
///     step 0.25                from one ray to the next, degrees; needed
///     offset 0.05 0 0.03       from the tilt axis to where rays begin, at tilt 0, metres, in the
///                              axes below (default 0 0 0)
///     range 0.1 80             what is nearer or farther, metres, is no return (default: all but
///                              0 is)
///
/// then a line a planar scan, in the order of the sweep, or the name of a file with its ranges
/// beside this one:
///
///     scan -40.5  1204 1210 ...      tilt of the plane, degrees, nose down positive
///     file -40.0  0042.txt
///
/// The frame is the tilting unit's at tilt 0: x straight ahead, y left, z up, and the tilt axis is
/// y. A ray of bearing b and range r at tilt t ends at R_y(t) (offset + r (cos b, sin b, 0)). The
/// cloud has a grid, a row a planar scan; no return is NaN. Its sensor pose is the origin, where
/// the axis is: rays begin `offset` beside it.
FileContents read_tilted_scans(const std::filesystem::path& path, PointsAs as,
                               const Context& context);

/// What the file of a folder of planar scans is called.
inline constexpr const char* tilted_scans_index = "scans.tilt";

}  // namespace roomscribe
