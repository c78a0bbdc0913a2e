// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/quadrilateral.hpp"

namespace roomscribe {

/// A connected planar surface of a world that was made, whatever things it belongs to: the fronts
/// of a kitchen that lie in one plane are one surface.
struct TrueSurface {
    Plane plane;        ///< in the map's frame; the sign means nothing
    double area = 0.0;  ///< m2
    /// Its corners, if it is a rectangle without holes: a leaf, a front, a board.
    std::optional<Quadrilateral> rectangle;
};

/// The planar surfaces of a world and the points that lie on them: what planes are held against.
struct SurfaceTruth {
    std::vector<TrueSurface> surfaces;
    /// Per point of the map: its surface, or -1 for what melts several surfaces into one return,
    /// ghosts, returns from outdoors and NaN.
    std::vector<std::int32_t> surface_of_point;
};

}  // namespace roomscribe
