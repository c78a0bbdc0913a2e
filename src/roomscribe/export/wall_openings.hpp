// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/export/building.hpp"
#include "roomscribe/export/planar_pieces.hpp"

namespace roomscribe {

/// Corners without repeated ones, counter-clockwise; empty if they enclose no area.
PlanePolygon clean_outline(const PlanePolygon& corners);

/// m2 that the openings of a wall take from its body: each opening within the body, and what two of
/// them share once.
double area_of_openings(const Building& building, std::size_t wall);

/// A flat component as convex pieces on its plane, in the room frame, corners as its own run.
using SpacePolygon = std::vector<Eigen::Vector3d>;
std::vector<SpacePolygon> pieces_of(const SpacePolygon& polygon);

/// A face of a wall without its doors, windows and passages: with `Wall::faces[face]`.
std::vector<SpacePolygon> pieces_of_face(const Building& building, std::size_t wall,
                                         std::size_t face);

/// A frame without the door or window in it.
std::vector<SpacePolygon> pieces_of_frame(const Building& building, const Opening& opening);

/// What is to be drawn of a flat component: a wall and a frame without what is in them. Empty for a
/// passage, which is the hole that it is.
std::vector<SpacePolygon> pieces_of_component(const Building& building, std::size_t component);

}  // namespace roomscribe
