// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {

struct BoundaryPointsSettings {
    double radius = 0.1;
    double max_angle = radians(90.0);

    void visit(SettingVisitor& visitor) {
        visitor(radius, {.name = "radius",
                         .unit = "m",
                         .min = 1e-9,
                         .max = 1e6,
                         .doc = "Neighbours lie no further off."});
        visitor(max_angle, {.name = "max_angle",
                            .unit = "rad",
                            .min = 0.0,
                            .max = 6.3,
                            .doc = "Largest angle between neighbouring directions to neighbours "
                                   "that a point inside the plane may have."});
    }
};

/// Boundary points of a plane as the paper finds them (section 4.3, Algorithm 3, step 2), by PCL's
/// angle criterion: seen from a boundary point, its neighbours, projected to the plane, leave a
/// sector wider than `max_angle` free. Rims of holes count as the outer rim does. As in PCL, a
/// point without two neighbours is not on the boundary. `points` number `positions`; the result is
/// a part of them in their order. Throws InvalidArgument if one is not finite.
std::vector<std::uint32_t> find_boundary_points(std::span<const Eigen::Vector3f> positions,
                                                std::span<const std::uint32_t> points,
                                                const Plane& plane,
                                                const BoundaryPointsSettings& settings = {},
                                                const Context& context = {});

}  // namespace roomscribe
