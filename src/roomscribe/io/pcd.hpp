// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/point_cloud_io.hpp"

namespace roomscribe {

/// PCL's point cloud data, version 0.7 and before: read_scan and write_point_cloud for one format.
/// HEIGHT above 1 is a scan grid. VIEWPOINT (tx ty tz qw qx qy qz) is the sensor pose unless it is
/// the default. In the compressed encoding each field stands on its own, all x before all y.
/// Source: pcl::PCDReader / PCDWriter, "The PCD file format".
FileContents read_pcd(const std::filesystem::path& path, PointsAs as, const Context& context);
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding,
               const Context& context);

}  // namespace roomscribe
