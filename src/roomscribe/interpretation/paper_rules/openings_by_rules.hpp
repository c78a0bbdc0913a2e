// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/interpretation/openings/wall_openings.hpp"
#include "roomscribe/interpretation/paper_rules/paper_rules_settings.hpp"
#include "roomscribe/interpretation/paper_rules/plane_quadrilaterals.hpp"
#include "roomscribe/interpretation/paper_rules/room_by_pass_through.hpp"

namespace roomscribe {

/// A quadrilateral that stands upright in a wall or closely behind it.
struct RuleRectangle {
    WallRectangle extent;  ///< m along the wall's `along`, and along up
    double depth = 0.0;    ///< m behind the wall's plane
};

/// A door or window, with the frame around it if there is one.
struct RuleOpening {
    OpeningType type = OpeningType::door;
    std::size_t wall = 0;  ///< of RuleRoom::walls
    RuleRectangle leaf;    ///< the door, or the window
    std::optional<RuleRectangle> frame;
};

/// Doors and windows by the sizes of the paper's section 4.3 and rules (iii) to (v) of its Table 3,
/// among the quadrilaterals parallel to a wall that lie in it, or behind it no deeper than a wall
/// is.
///
/// Door: of a door's size, upright, its lower edge very close to the floor (of the wall, where
/// there is no floor). Window: of a window's size, lying or standing, in the upper half of its
/// wall, and embedded: what lies before the wall where the window is ("pictures tumble out") covers
/// less than a tenth of it, at the density of the wall's points. Frame: the largest quadrilateral
/// around a door or window that is not wider on any side than a frame is. Of quadrilaterals that
/// overlap, the smallest is the opening.
std::vector<RuleOpening> find_openings_by_rules(const PointCloud& map,
                                                std::span<const PlanarPatch> planes,
                                                std::span<const PlaneQuadrilateral> quadrilaterals,
                                                const RuleRoom& room, const Eigen::Vector3d& up,
                                                double plane_tolerance,
                                                const PaperRulesSettings& settings = {});

}  // namespace roomscribe
