// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/units.hpp"

namespace roomscribe {

/// A direction that much surface of a scan faces: a wall's, the floor's.
struct SurfaceDirection {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    double share = 0.0;  ///< of the points
};

/// Normals of one flat surface lie within this angle of their mean as a rule, and those of two
/// surfaces that are not parallel do not.
inline constexpr double same_direction_angle = radians(10.0);

/// The directions that at least a fiftieth of the normals share, most shared first, at most 12:
/// modes of the normals on the sphere (mean shift). NaN normals count for nothing.
std::vector<SurfaceDirection> find_surface_directions(std::span<const Eigen::Vector3f> normals);

/// Large flat surface of a scan: what all rooms have, and what many of them have in the same
/// places.
struct ShellPlane {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    double offset = 0.0;  ///< m along the direction
};

/// The planes along the directions that hold at least `min_area` of surface. `spacing` is that of
/// the points, of which each stands for its square.
std::vector<ShellPlane> find_shell(std::span<const Eigen::Vector3f> positions,
                                   std::span<const Eigen::Vector3f> normals,
                                   std::span<const SurfaceDirection> directions, double spacing,
                                   double min_area);

/// True if the point lies within `margin` of one of the planes and looks its way.
bool is_on_shell(std::span<const ShellPlane> shell, const Eigen::Vector3f& position,
                 const Eigen::Vector3f& normal, double margin);

}  // namespace roomscribe
