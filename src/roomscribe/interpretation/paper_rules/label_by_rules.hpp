// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/interpretation/paper_rules/paper_rules_settings.hpp"
#include "roomscribe/interpretation/paper_rules/plane_quadrilaterals.hpp"
#include "roomscribe/model/scene.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

struct RuleLabels {
    Scene scene;         ///< components and the room frame; no rooms, which the paper does not tell
    PointLabels labels;  ///< of every point of the map, in its order
};

/// The paper's labelling (sections 4.1 and 4.3, Table 3): find_room_by_pass_through, then
/// find_openings_by_rules, as components, and a label for every point. Inliers of a plane have the
/// label of the plane; what lies within the rectangle of a door or window, from the tolerance of
/// the planes before its wall to the depth of the wall behind it, is the door's or the window's,
/// and what lies so between that rectangle and the one around it is the frame's. All others are
/// unknown: furniture and handles are Algorithm 5's.
///
/// `planes` are those of the map, largest first; `room_from_map` has the axes x, y, z as rows;
/// `plane_tolerance` (m) is what the planes were found with. Confidences are the accuracies that
/// the paper states of its labels (Table 4). In the room frame the floor is z = 0, or what is
/// lowest where no floor was found, and the walls' box begins at x = y = 0.
RuleLabels label_by_rules(const PointCloud& map, std::span<const PlanarPatch> planes,
                          std::span<const PlaneQuadrilateral> quadrilaterals,
                          const Eigen::Matrix3d& room_from_map, double plane_tolerance,
                          const PaperRulesSettings& settings = {}, const Context& context = {});

}  // namespace roomscribe
