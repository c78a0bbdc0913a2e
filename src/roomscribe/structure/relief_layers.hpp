// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {

/// m: plaster, wood and paint are rough by so much. What is measured more finely is no relief.
inline constexpr double surface_roughness = 0.001;

/// A point near the plane: its number and the standard deviation, m, of its measurement.
struct ReliefPoint {
    std::uint32_t point;
    float noise;
};

/// In layer_of_point: on no layer.
inline constexpr std::uint32_t no_layer = 0xFFFFFFFFU;

/// Points near a plane, sorted by the height over it at which they lie together.
struct ReliefLayers {
    std::uint32_t num_layers = 0;
    std::vector<std::uint32_t> layer_of_point;  ///< per given point
};

/// Tells surfaces apart that are parallel and nearly in one plane: a door leaf from its wall, a
/// picture, a skirting board. The plane is cut into tiles. In each tile the heights of the points
/// have a mode per surface: the peaks of their density that a clear valley parts. Modes of
/// neighbouring tiles at one height make a layer, which may so follow a wall that is out of true.
/// Each stretch of surface counts alike, whatever its point density. Two surfaces need to be two to
/// three standard deviations of the noise apart. Surfaces are
/// even over a tile of `tile_size` m.
ReliefLayers find_relief_layers(std::span<const Eigen::Vector3f> positions,
                                std::span<const ReliefPoint> points, const Plane& plane,
                                double tile_size);

}  // namespace roomscribe
