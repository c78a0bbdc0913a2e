// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// What a surface does to a ray at near-infrared (850 to 905 nm, where these scanners work).
enum class Material : std::uint8_t {
    paint,  ///< white or light wall paint, plaster
    wood,   ///< light wood and laminate
    dark_wood,
    fabric,
    carpet,
    tile,     ///< glazed tile, polished stone: some gloss
    lacquer,  ///< glossy white kitchen fronts
    metal,    ///< brushed steel of handles, fridges
    chrome,   ///< shiny metal: mostly lost
    black_plastic,
    screen,  ///< dark and glossy
    paper,
    plant,
    facade,  ///< outdoors
    glass,   ///< lets most rays through
    mirror
};

/// Surfaces that mean the same: one label, one component, one material.
struct WorldPart {
    std::int32_t component = -1;  ///< index into scene.components, or -1
    Label label = Label::unknown;
    LabelSet acceptable = label_bit(Label::unknown);  ///< the labels that are right for its points
    Material material = Material::paint;
    double transparency = 0.0;  ///< share of rays that pass, for glass
};

/// A building with all that stands in it: triangles for rays to hit, and the scene that they mean.
/// In the building's frame: z up, the floor at z = 0, x and y along the dominant walls.
struct SimulatedWorld {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> part_of_triangle;
    std::vector<WorldPart> parts;
    Scene scene;  ///< room_from_map is the identity
};

/// Adds a component, numbers it (`instance` = index, `id` = "<label or kind>-<n>") unless it has an
/// id, with full confidence, accepted. Returns its index.
std::int32_t add_component(SimulatedWorld& world, Component component);

/// Adds a part that belongs to a component and takes its label; `also_right` are further labels
/// that are right for its points. Returns its number.
std::uint32_t add_part(SimulatedWorld& world, std::int32_t component, Material material,
                       LabelSet also_right = 0);

/// Adds a part of nothing: clutter, the outdoors. Its points are unknown.
std::uint32_t add_clutter_part(SimulatedWorld& world, Material material);

/// Planar polygon without holes, simple, corners in order (ear clipping).
void add_polygon(SimulatedWorld& world, std::uint32_t part,
                 std::span<const Eigen::Vector3d> corners);

/// Corners in order.
void add_quad(SimulatedWorld& world, std::uint32_t part, const Eigen::Vector3d& a,
              const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d);

/// Box [low, high] of a local frame, all six sides.
void add_box(SimulatedWorld& world, std::uint32_t part, const Transform& world_from_local,
             const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// Closed cylinder about the line from `start` to `end`, as a prism of `sides` sides.
void add_cylinder(SimulatedWorld& world, std::uint32_t part, const Eigen::Vector3d& start,
                  const Eigen::Vector3d& end, double radius, int sides = 16);

/// Half-sphere-like or full ellipsoid blob, for cushions, balls, plants and bags.
void add_ellipsoid(SimulatedWorld& world, std::uint32_t part, const Transform& world_from_local,
                   const Eigen::Vector3d& radii, int sides = 12);

}  // namespace roomscribe
