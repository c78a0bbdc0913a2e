// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/core/context.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe {

/// Points of a map on a grid of 65,536 steps along each axis of a cube, sorted along a
/// space-filling curve (Morton 1966), so that the cells of every octree over the cube are runs of
/// points.
struct GriddedPoints {
    Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< corner of the cube, in the room frame
    Eigen::Vector3d size_of_box = Eigen::Vector3d::Zero();  ///< m, of the box that holds them
    double step = 1.0;                                      ///< m
    std::vector<std::array<std::uint16_t, 3>> places;
    std::vector<std::uint32_t> numbers;  ///< of the points in the map
    /// Octree level, 0 to 16, from which on a point and the one before it are in cells of their
    /// own; 17 where both have the same place.
    std::vector<std::uint8_t> levels;

    std::size_t size() const { return numbers.size(); }
};

/// The finite points of the map that lie in the box, which is in the room frame. Of points in one
/// place of the grid the first stays.
GriddedPoints grid_points(const Reconstruction& reconstruction, const Eigen::AlignedBox3d& box,
                          const Context& context = {});

/// Numbers into `points`, ascending: all of them, or `budget` that are spread evenly over the
/// surfaces. One of each cell of the finest octree level that has no more cells than the budget,
/// and the rest evenly from the cells of the next.
std::vector<std::uint32_t> thin_points(const GriddedPoints& points, std::size_t budget);

/// Which room, counted from 1 (0: none), each of these points is in: by what it belongs to, else by
/// the plan of the rooms.
std::vector<std::uint8_t> rooms_of_points(const Reconstruction& reconstruction,
                                          const GriddedPoints& points,
                                          std::span<const std::uint32_t> chosen);

/// The chosen points as the viewer reads them (docs/viewer.md): one plane of bytes per property,
/// compressed by zlib.
std::string pack_points(const Reconstruction& reconstruction, const GriddedPoints& points,
                        std::span<const std::uint32_t> chosen);

}  // namespace roomscribe
