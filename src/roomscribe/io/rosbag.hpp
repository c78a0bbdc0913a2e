// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// ROS 1 bags. Where there are sensor_msgs/PointCloud2 messages, each is a scan, 100 at most of a
/// topic, evenly; properties as in PCD. Else planar scans are assembled, the paper's way of
/// recording (section 3.1): a cloud per topic whose messages hold a sensor_msgs/LaserScan, be it
/// within a type of anybody's own, a row of the grid per scan. How a scan lay is told by
///
///   - a number beside the LaserScan in its message whose name has "angle", "tilt" or "pitch" in
///   it:
///     nose down positive, about the axis y of the frame, which is x ahead, y left, z up; degrees
///     if the numbers go beyond 2 pi;
///   - else by /tf and /tf_static, at the time of each ray; the frame is the root of the tree.
///
/// Ranges outside of range_min and range_max are no returns. Throws IoError if there is neither, or
/// nothing that says how the scanner was turned.
std::vector<FileContents> read_rosbag(const std::filesystem::path& path, PointsAs as,
                                      const Context& context);

}  // namespace roomscribe
