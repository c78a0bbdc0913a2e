// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Geometry>

namespace roomscribe {

/// Axis-aligned box of the finite points; empty (Eigen's isEmpty()) if there are none.
Eigen::AlignedBox3f bounding_box(std::span<const Eigen::Vector3f> points);

}  // namespace roomscribe
