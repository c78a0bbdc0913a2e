// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

/// A cloud, and how it stood in its file.
struct FileContents {
    PointCloud cloud;
    std::string format;
    std::string encoding;
    std::vector<Field> fields;
    std::vector<std::string> warnings;  ///< what was in the file and is not in the cloud
};

}  // namespace roomscribe
