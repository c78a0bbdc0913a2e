// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/ros_message.hpp"

namespace roomscribe {

/// The points of a sensor_msgs/PointCloud2, properties as in PCD. Throws Error, with the reason, if
/// it promises more than its bytes hold.
FileContents read_point_cloud2(const RosMessage& message, PointsAs as, const Context& context);

}  // namespace roomscribe
