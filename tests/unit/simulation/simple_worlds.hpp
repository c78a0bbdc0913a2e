// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe::test {

/// Adds a component, and a quadrilateral of it.
inline std::uint32_t add_surface(SimulatedWorld& world, Label label, Material material,
                                 const std::vector<Eigen::Vector3d>& corners) {
    Component component;
    component.label = label;
    const std::uint32_t part =
        add_part(world, add_component(world, std::move(component)), material);
    add_quad(world, part, corners[0], corners[1], corners[2], corners[3]);
    return part;
}

/// A wall across the x axis at `x`, as wide and high as 2 `half`, about y = z = 0.
inline std::uint32_t add_screen(SimulatedWorld& world, double x, Material material,
                                double half = 50.0, Label label = Label::wall) {
    return add_surface(world, label, material,
                       {{x, -half, -half}, {x, half, -half}, {x, half, half}, {x, -half, half}});
}

/// The inside of a box about the origin, all six sides of paint: floor, ceiling, walls at -x, +x,
/// -y, +y, in this order.
inline SimulatedWorld box_room(double half_x, double half_y, double half_z) {
    const double x = half_x;
    const double y = half_y;
    const double z = half_z;
    SimulatedWorld world;
    add_surface(world, Label::floor, Material::paint,
                {{-x, -y, -z}, {x, -y, -z}, {x, y, -z}, {-x, y, -z}});
    add_surface(world, Label::ceiling, Material::paint,
                {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}});
    add_surface(world, Label::wall, Material::paint,
                {{-x, -y, -z}, {-x, y, -z}, {-x, y, z}, {-x, -y, z}});
    add_surface(world, Label::wall, Material::paint,
                {{x, -y, -z}, {x, y, -z}, {x, y, z}, {x, -y, z}});
    add_surface(world, Label::wall, Material::paint,
                {{-x, -y, -z}, {x, -y, -z}, {x, -y, z}, {-x, -y, z}});
    add_surface(world, Label::wall, Material::paint,
                {{-x, y, -z}, {x, y, -z}, {x, y, z}, {-x, y, z}});
    return world;
}

}  // namespace roomscribe::test
