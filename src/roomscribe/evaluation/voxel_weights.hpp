// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"

namespace roomscribe {

/// One over the number of points that share the point's voxel, so that every voxel counts once in
/// a sum over points; 0 for a point without finite coordinates.
std::vector<float> voxel_weights(std::span<const Eigen::Vector3f> points, double voxel_size,
                                 const Context& context = {});

/// The voxels that the points fill, as keys in ascending order.
std::vector<std::uint64_t> filled_voxels(std::span<const Eigen::Vector3f> points, double voxel_size,
                                         const Context& context = {});

}  // namespace roomscribe
