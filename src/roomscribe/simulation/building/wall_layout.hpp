// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// One side of a room: the finished face of a wall. The room lies to the left of start -> end.
struct BuiltWallFace {
    std::size_t room = 0;
    Eigen::Vector2d start = Eigen::Vector2d::Zero();
    Eigen::Vector2d end = Eigen::Vector2d::Zero();

    double length() const { return (end - start).norm(); }
    Eigen::Vector2d along() const { return (end - start).normalized(); }
    Eigen::Vector2d inward() const { return {-along().y(), along().x()}; }
};

/// All faces, room by room, in the order of their outlines.
std::vector<BuiltWallFace> wall_faces(std::span<const RoomPlan> rooms);

/// The face behind a point of a face: parallel within 2 degrees, looking the other way, at most
/// 0.6 m off (the thickest inner walls are load-bearing ones of about 0.5 m).
struct FarFace {
    std::size_t face = 0;
    double thickness = 0.0;  ///< m, of the wall between the two
};
std::optional<FarFace> find_far_face(std::span<const BuiltWallFace> faces, std::size_t face,
                                     const Eigen::Vector2d& point);

/// Where in the walls an opening is.
struct OpeningSite {
    std::size_t face = 0;
    std::optional<std::size_t> far_face;  ///< empty for outdoors, and for a niche
    double thickness = 0.0;               ///< of the wall
    double floor = 0.0;                   ///< z of the room's floor
    /// x to the left as seen from the room, y into the room, z up; the origin is the middle of the
    /// opening on the wall face, at the floor.
    Transform world_from_site = Transform::Identity();
};

/// Throws InvalidArgument if a size is negative, the room is not known, `at` is not within 5 cm of
/// one of its faces, or the hole would not lie wholly within that face. That it also lies within
/// the face behind is up to the scenario.
OpeningSite locate_opening(const OpeningPlan& opening, std::span<const RoomPlan> rooms,
                           std::span<const BuiltWallFace> faces, double outer_wall_thickness);

/// A rectangle in the plane of a wall: x along it, z up. On a face x runs from its start and z is
/// the world's; at an opening's site both are the site's.
struct WallArea {
    double x_low = 0.0;
    double x_high = 0.0;
    double z_low = 0.0;
    double z_high = 0.0;
};

/// Half the width of the hole in the wall, and its height: a door's frame is set into the hole.
double hole_half_width(const OpeningPlan& opening);
double hole_height(const OpeningPlan& opening);

Eigen::AlignedBox2d bounds_of(std::span<const Eigen::Vector2d> outline);

/// From a point to the nearest one of the line from `a` to `b`.
double distance_to_segment(const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b);

/// True inside a simple polygon.
bool contains(std::span<const Eigen::Vector2d> outline, const Eigen::Vector2d& point);

}  // namespace roomscribe
