// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/io/point_fields.hpp"
#include "roomscribe/io/point_summary.hpp"

namespace roomscribe {

/// What a reader makes of the points of a file.
enum class PointsAs {
    cloud,
    summary  ///< they pass by and are not kept
};

/// A scan, and how it stood in its file.
struct FileContents {
    PointCloud cloud;  ///< without points where a summary was asked for
    std::string format;
    std::string encoding;
    std::vector<Field> fields;
    std::vector<std::string>
        warnings;           ///< what was in the file and is not in the cloud, or guessed
    std::string name = {};  ///< what the file calls the scan; mostly empty
    /// Where the scan stands, both in the file's own coordinates, if the file says so.
    std::optional<Transform> map_from_scan = std::nullopt;
    PointSummary summary = {};  ///< where it was asked for; without the global shift
};

/// For readers that make a cloud whole: turns its points into their summary if that was asked for.
void keep_points(PointsAs as, FileContents& contents);

}  // namespace roomscribe
