// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/model/scene.hpp"

namespace roomscribe::cli {

/// How large something is, as people say it of things that stand upright.
struct Extent {
    double width = 0.0;  ///< m, along the horizontal
    /// m; of what lies (floors, table tops) across the width instead.
    double height = 0.0;
    std::optional<double> depth;  ///< m, of what has a box
    std::optional<double> area;   ///< m2, of what has a polygon
    bool is_level = false;
};

/// What follows from a scene for one of its components. Pointers are into the scene.
struct ComponentFacts {
    const Component* component = nullptr;
    std::optional<Extent> extent;
    std::optional<Eigen::Vector3d> center;  ///< m, room frame
    const Room* room = nullptr;             ///< by its parents, else the one that it stands in
    std::optional<double> above_floor;      ///< m, its lowest corner over the floor of its room
    /// Of what it belongs to: the nearest first.
    std::vector<const Component*> parents;
    /// m, from its sides to the ends of the wall that it is in.
    std::optional<std::array<double, 2>> to_wall_ends;
    std::vector<const Component*> parts;  ///< whose parent it is
    /// The frame around a door or window, the door or window in a frame.
    const Component* counterpart = nullptr;
    std::vector<std::string> joins;  ///< ids of the rooms that it leads from and to
};

ComponentFacts gather_facts(const Scene& scene, const Component& component);

}  // namespace roomscribe::cli
