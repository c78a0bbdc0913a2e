// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

/// A scan, and how it stood in its file.
struct FileContents {
    PointCloud cloud;
    std::string format;
    std::string encoding;
    std::vector<Field> fields;
    std::vector<std::string>
        warnings;           ///< what was in the file and is not in the cloud, or guessed
    std::string name = {};  ///< what the file calls the scan; mostly empty
    /// Where the scan stands, both in the file's own coordinates, if the file says so.
    std::optional<Transform> map_from_scan = std::nullopt;
};

}  // namespace roomscribe
