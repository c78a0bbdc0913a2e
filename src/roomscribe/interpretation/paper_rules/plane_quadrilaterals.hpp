// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/geometry/quadrilateral.hpp"
#include "roomscribe/interpretation/paper_rules/paper_rules_settings.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

/// A rectangular shape in the boundaries of a plane: its rim, or that of a hole in it.
struct PlaneQuadrilateral {
    Quadrilateral quadrilateral;  ///< its corners lie on the plane
    std::uint32_t plane = 0;      ///< number of the plane
};

/// Lengths of the sides of a quadrilateral: the mean of the first side and the one opposite, and
/// that of the other two.
struct SideLengths {
    double first = 0.0;   ///< m, from corner 0 to 1
    double second = 0.0;  ///< m, from corner 1 to 2
};
SideLengths side_lengths(const Quadrilateral& quadrilateral);

/// The paper's section 4.3, steps 1 to 3, for each plane: boundary points, lines through them
/// (Algorithm 3), and the quadrilaterals that these make (Algorithm 4), plane after plane.
/// `point_spacing` (m) is that of the cloud; of 0 there are none. The points of the planes number
/// the cloud's.
std::vector<PlaneQuadrilateral> find_plane_quadrilaterals(const PointCloud& cloud,
                                                          std::span<const PlanarPatch> planes,
                                                          double point_spacing, std::uint64_t seed,
                                                          const PaperRulesSettings& settings = {},
                                                          const Context& context = {});

}  // namespace roomscribe
