// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

enum class HandleShape : std::uint8_t {
    none,
    bar,   ///< a straight bar on two posts
    bow,   ///< an arch from hole to hole
    knob,  ///< a head on a stem
    lever  ///< a lever on a rosette, as doors have it
};

struct HandleStyle {
    HandleShape shape = HandleShape::none;
    double hole_spacing = 0.128;  ///< bar, bow: between the posts' middles; lever: its length
    double overhang = 0.02;       ///< of a bar beyond the middle of each post
    double diameter = 0.012;      ///< of the bar, of the knob's head, of the lever
    double projection = 0.032;    ///< from the face to the handle's outermost point
    Material material = Material::metal;

    /// Along the bar, the diameter of a knob.
    double length() const;
};

/// A make of furniture handle, of sizes as they are sold.
HandleStyle choose_handle(Random& random);

/// The same make with the largest hole spacing that leaves the handle no longer than `max_length`.
HandleStyle fitted_handle(HandleStyle style, double max_length);

/// Adds a handle with its box and grasp. Its frame: x along the bar, z out of the face, the origin
/// on the face behind the handle's middle (of a lever: behind its spindle, x along the lever).
void add_handle(SimulatedWorld& world, const Transform& world_from_handle, const HandleStyle& style,
                const std::string& parent);

}  // namespace roomscribe
