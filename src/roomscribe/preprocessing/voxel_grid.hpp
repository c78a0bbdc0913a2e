// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

struct VoxelGridSettings {
    double voxel_size = 0.05;

    void visit(SettingVisitor& visitor) {
        visitor(voxel_size, {.name = "voxel_size",
                             .unit = "m",
                             .min = 1e-6,
                             .max = 1e6,
                             .doc = "Edge of a voxel."});
    }
};

/// In VoxelGrid::voxel_of_point: the point is not finite and lies in no voxel.
inline constexpr std::uint32_t no_voxel = std::numeric_limits<std::uint32_t>::max();

struct VoxelGrid {
    /// One point per occupied voxel: the centroid of its points (and their mean normal, if the
    /// input has normals). Sorted by voxel, so that the order of the input does not matter.
    PointCloud cloud;
    std::vector<std::uint32_t> num_points;      ///< per voxel: input points in it
    std::vector<std::uint32_t> voxel_of_point;  ///< per input point: its voxel, or no_voxel
};

/// Thins a cloud to one point per cubic voxel. Voxels are aligned to the cloud's own axes. Points
/// that are not finite, or lie more than 10^9 voxels out, are left out. Colours, intensities and
/// channels are dropped.
VoxelGrid downsample_voxel_grid(const PointCloud& cloud, const VoxelGridSettings& settings = {},
                                const Context& context = {});

}  // namespace roomscribe
