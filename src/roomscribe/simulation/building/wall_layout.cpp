// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/building/wall_layout.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

constexpr double thickest_inner_wall = 0.6;
constexpr double opening_tolerance = 0.05;

struct PointOnFace {
    double along = 0.0;
    double distance = 0.0;  ///< into the room
};

PointOnFace place_on_face(const BuiltWallFace& face, const Vector2d& point) {
    const Vector2d offset = point - face.start;
    return {offset.dot(face.along()), offset.dot(face.inward())};
}

void check_sizes(const OpeningPlan& opening) {
    const bool is_window = opening.kind == OpeningKind::window;
    const double rim = is_window ? 2.0 * opening.frame_width : 0.0;
    if (!(opening.width > rim && opening.height > rim && opening.sill >= 0.0 &&
          opening.frame_width >= 0.0 && opening.frame_protrusion >= 0.0 && opening.recess >= 0.0)) {
        throw InvalidArgument(
            "opening",
            fmt::format("{} x {} m in room \"{}\"", opening.width, opening.height, opening.room),
            "sizes of 0 or more, wider and higher than the frame of a window");
    }
}

}  // namespace

std::vector<BuiltWallFace> wall_faces(std::span<const RoomPlan> rooms) {
    std::vector<BuiltWallFace> faces;
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        const std::vector<Vector2d>& outline = rooms[room].outline;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            faces.push_back({room, outline[i], outline[(i + 1) % outline.size()]});
        }
    }
    return faces;
}

std::optional<FarFace> find_far_face(std::span<const BuiltWallFace> faces, std::size_t face,
                                     const Vector2d& point) {
    std::optional<FarFace> nearest;
    const Vector2d inward = faces[face].inward();
    for (std::size_t other = 0; other < faces.size(); ++other) {
        if (faces[other].inward().dot(inward) > -std::cos(radians(2.0))) continue;
        const PointOnFace place = place_on_face(faces[other], point);
        const double thickness = -place.distance;
        if (place.along < 0.0 || place.along > faces[other].length() || thickness < 0.0 ||
            thickness > thickest_inner_wall || (nearest && nearest->thickness < thickness)) {
            continue;
        }
        nearest = {other, thickness};
    }
    return nearest;
}

OpeningSite locate_opening(const OpeningPlan& opening, std::span<const RoomPlan> rooms,
                           std::span<const BuiltWallFace> faces, double outer_wall_thickness) {
    check_sizes(opening);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (rooms[faces[i].room].name != opening.room) continue;
        const PointOnFace place = place_on_face(faces[i], opening.at);
        const double half_width = hole_half_width(opening);
        if (std::abs(place.distance) > opening_tolerance || place.along < half_width ||
            place.along > faces[i].length() - half_width ||
            rooms[faces[i].room].floor_height + opening.sill + hole_height(opening) >
                rooms[faces[i].room].ceiling_height) {
            continue;
        }
        const double floor = rooms[faces[i].room].floor_height;
        const Vector2d middle = faces[i].start + place.along * faces[i].along();
        OpeningSite site{
            .face = i, .far_face = {}, .thickness = outer_wall_thickness, .floor = floor};
        site.world_from_site.linear().col(0) << faces[i].along(), 0.0;
        site.world_from_site.linear().col(1) << faces[i].inward(), 0.0;
        site.world_from_site.translation() << middle, floor;
        if (opening.kind == OpeningKind::niche) return site;
        if (const std::optional<FarFace> far = find_far_face(faces, i, middle)) {
            site.far_face = far->face;
            site.thickness = far->thickness;
        }
        return site;
    }
    throw InvalidArgument(
        "opening",
        fmt::format("at ({}, {}) in room \"{}\"", opening.at.x(), opening.at.y(), opening.room),
        "a place on a wall of that room, wholly within it");
}

double hole_half_width(const OpeningPlan& opening) {
    const bool is_framed_outside =
        opening.kind == OpeningKind::door || opening.kind == OpeningKind::passage;
    return opening.width / 2.0 + (is_framed_outside ? opening.frame_width : 0.0);
}

double hole_height(const OpeningPlan& opening) {
    const bool is_framed_outside =
        opening.kind == OpeningKind::door || opening.kind == OpeningKind::passage;
    return opening.height + (is_framed_outside ? opening.frame_width : 0.0);
}

Eigen::AlignedBox2d bounds_of(std::span<const Vector2d> outline) {
    Eigen::AlignedBox2d bounds;
    for (const Vector2d& corner : outline)
        bounds.extend(corner);
    return bounds;
}

double distance_to_segment(const Vector2d& point, const Vector2d& a, const Vector2d& b) {
    const Vector2d along = b - a;
    const double share = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (point - a - share * along).norm();
}

bool contains(std::span<const Vector2d> outline, const Vector2d& point) {
    bool is_inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const Vector2d& a = outline[i];
        const Vector2d& b = outline[j];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        if (point.x() < (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()) + a.x()) {
            is_inside = !is_inside;
        }
    }
    return is_inside;
}

}  // namespace roomscribe
