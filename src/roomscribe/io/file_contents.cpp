// SPDX-License-Identifier: MIT
#include "roomscribe/io/file_contents.hpp"

#include <utility>

namespace roomscribe {

void keep_points(PointsAs as, FileContents& contents) {
    if (as == PointsAs::cloud) return;
    const PointCloud cloud = std::exchange(contents.cloud, {});
    contents.summary = summarize_points(cloud.positions, 0, cloud.size());
    contents.cloud.grid = cloud.grid;
    contents.cloud.sensor_pose = cloud.sensor_pose;
    contents.cloud.global_shift = cloud.global_shift;
}

}  // namespace roomscribe
