// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "roomscribe/interpretation/paper_rules/paper_rules_settings.hpp"
#include "roomscribe/interpretation/paper_rules/plane_quadrilaterals.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/principal_axes.hpp"

namespace roomscribe {

enum class DoorOrientationStop : std::uint8_t {
    door_found,  ///< num_doors > 0
    no_door      ///< no small quadrilateral stands like a door on an edge of a bigger one
};
std::string_view door_orientation_stop_name(DoorOrientationStop stop);

struct DoorOrientation {
    /// Map frame -> room frame, without translation: z is up, y the door's normal, x = y x z. The
    /// identity without a door.
    Eigen::Matrix3d room_from_map = Eigen::Matrix3d::Identity();
    DoorOrientationStop stop = DoorOrientationStop::no_door;
    /// Doors that say that z is up: the paper speaks of one; where several disagree, most decide.
    std::size_t num_doors = 0;
    std::size_t door = 0;  ///< number of the quadrilateral whose normal is y
    std::size_t wall = 0;  ///< number of the bigger quadrilateral
};

/// Which way is up, by the paper's section 4.3: a small quadrilateral of a door's size within a
/// bigger one (at least twice its area, in its plane or parallel to it and no further from it than
/// a wall is deep), one short edge of which is very close to an edge of the bigger one, is a door;
/// it stands on the floor there, and z points from that edge to the door. `axes` are the initial
/// guess (Algorithm 2), which the door puts in their order: z and y are the axes nearest to what
/// the door says, and a door that agrees with none up to `angle_tolerance` says nothing. A door as
/// high as its wall, both of whose short edges are close to edges, says nothing either.
DoorOrientation orient_by_door(std::span<const PlaneQuadrilateral> quadrilaterals,
                               std::span<const PlanarPatch> planes, const PrincipalAxes& axes,
                               const PaperRulesSettings& settings = {});

}  // namespace roomscribe
