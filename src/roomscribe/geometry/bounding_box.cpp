// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/bounding_box.hpp"

namespace roomscribe {

Eigen::AlignedBox3f bounding_box(std::span<const Eigen::Vector3f> points) {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& point : points) {
        if (point.allFinite()) box.extend(point);
    }
    return box;
}

}  // namespace roomscribe
