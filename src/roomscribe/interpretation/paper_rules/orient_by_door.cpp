// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/paper_rules/orient_by_door.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// "Bigger": a wall is at least twice as large as its door.
constexpr double min_area_ratio = 2.0;

struct Edge {
    Vector3d start;
    Vector3d end;

    Vector3d middle() const { return 0.5 * (start + end); }
    Vector3d direction() const { return (end - start).normalized(); }
};

Edge edge_of(const Quadrilateral& quadrilateral, std::size_t number) {
    return {quadrilateral.corners[number], quadrilateral.corners[(number + 1) % 4]};
}

bool is_about(double value, double expected, double tolerance) {
    return std::abs(value - expected) <= tolerance * expected;
}

/// Number of the first of the two short edges of a quadrilateral of a door's size.
std::optional<std::size_t> short_edge_of_door(const Quadrilateral& quadrilateral,
                                              const PaperRulesSettings& settings) {
    const SideLengths sides = side_lengths(quadrilateral);
    const double width = std::min(sides.first, sides.second);
    const double height = std::max(sides.first, sides.second);
    if (!is_about(width, settings.door_width, settings.size_tolerance) ||
        !is_about(height, settings.door_height, settings.size_tolerance)) {
        return std::nullopt;
    }
    return sides.first < sides.second ? 0 : 1;
}

/// Whether an edge runs along an edge of the bigger quadrilateral, very close to it.
bool is_on_an_edge(const Edge& edge, const Quadrilateral& bigger, const Plane& plane,
                   const PaperRulesSettings& settings) {
    const Vector3d middle = plane.project(edge.middle());
    for (std::size_t i = 0; i < 4; ++i) {
        const Edge other = edge_of(bigger, i);
        const Vector3d along = other.direction();
        if (std::abs(along.dot(edge.direction())) < std::cos(settings.angle_tolerance)) continue;
        const Vector3d offset = middle - other.start;
        const double position = offset.dot(along);
        const bool is_beside = position < 0.0 || position > (other.end - other.start).norm();
        if (!is_beside && (offset - position * along).norm() <= settings.edge_distance) return true;
    }
    return false;
}

bool is_parallel_and_near(const PlaneQuadrilateral& door, const PlaneQuadrilateral& wall,
                          std::span<const PlanarPatch> planes, const PaperRulesSettings& settings) {
    const Plane& plane = planes[wall.plane].plane;
    return std::abs(plane.normal.dot(planes[door.plane].plane.normal)) >=
               std::cos(settings.angle_tolerance) &&
           std::abs(plane.signed_distance(door.quadrilateral.center())) <= settings.wall_depth;
}

/// From the edge that is on the edge of the wall towards the door.
std::optional<Vector3d> up_of(const PlaneQuadrilateral& door, std::size_t short_edge,
                              const PlaneQuadrilateral& wall, std::span<const PlanarPatch> planes,
                              const PaperRulesSettings& settings) {
    const SideLengths small = side_lengths(door.quadrilateral);
    const SideLengths big = side_lengths(wall.quadrilateral);
    if (big.first * big.second < min_area_ratio * small.first * small.second ||
        !is_parallel_and_near(door, wall, planes, settings)) {
        return std::nullopt;
    }
    const Plane& plane = planes[wall.plane].plane;
    const std::array<Edge, 2> edges{edge_of(door.quadrilateral, short_edge),
                                    edge_of(door.quadrilateral, short_edge + 2)};
    const bool first = is_on_an_edge(edges[0], wall.quadrilateral, plane, settings);
    const bool second = is_on_an_edge(edges[1], wall.quadrilateral, plane, settings);
    if (first == second) return std::nullopt;
    return (door.quadrilateral.center() - edges[first ? 0 : 1].middle()).normalized();
}

/// An axis of the initial guess, with its sign.
struct SignedAxis {
    Eigen::Index axis = 0;
    double sign = 1.0;
};

std::optional<SignedAxis> nearest_axis(const Eigen::Matrix3d& axes, const Vector3d& direction,
                                       double angle_tolerance) {
    const Vector3d cosines = axes.transpose() * direction;
    SignedAxis result;
    const double cosine = cosines.cwiseAbs().maxCoeff(&result.axis);
    if (cosine < std::cos(angle_tolerance)) return std::nullopt;
    result.sign = cosines[result.axis] < 0.0 ? -1.0 : 1.0;
    return result;
}

struct Candidate {
    SignedAxis up;
    std::size_t door = 0;
    std::size_t wall = 0;
};

std::vector<Candidate> find_candidates(std::span<const PlaneQuadrilateral> quadrilaterals,
                                       std::span<const PlanarPatch> planes,
                                       const Eigen::Matrix3d& axes,
                                       const PaperRulesSettings& settings) {
    std::vector<Candidate> candidates;
    for (std::size_t door = 0; door < quadrilaterals.size(); ++door) {
        const auto short_edge = short_edge_of_door(quadrilaterals[door].quadrilateral, settings);
        if (!short_edge) continue;
        for (std::size_t wall = 0; wall < quadrilaterals.size(); ++wall) {
            const auto up =
                up_of(quadrilaterals[door], *short_edge, quadrilaterals[wall], planes, settings);
            const auto axis = up ? nearest_axis(axes, *up, settings.angle_tolerance) : std::nullopt;
            if (!axis) continue;
            candidates.push_back({*axis, door, wall});
            break;
        }
    }
    return candidates;
}

}  // namespace

std::string_view door_orientation_stop_name(DoorOrientationStop stop) {
    return stop == DoorOrientationStop::door_found ? "door_found" : "no_door";
}

DoorOrientation orient_by_door(std::span<const PlaneQuadrilateral> quadrilaterals,
                               std::span<const PlanarPatch> planes, const PrincipalAxes& axes,
                               const PaperRulesSettings& settings) {
    check_settings(settings);
    DoorOrientation result;
    const std::vector<Candidate> candidates =
        find_candidates(quadrilaterals, planes, axes.axes, settings);
    for (const Candidate& candidate : candidates) {
        const auto num_alike = static_cast<std::size_t>(
            std::count_if(candidates.begin(), candidates.end(), [&](const Candidate& other) {
                return other.up.axis == candidate.up.axis && other.up.sign == candidate.up.sign;
            }));
        if (num_alike <= result.num_doors) continue;
        const Vector3d z = candidate.up.sign * axes.axes.col(candidate.up.axis);
        const Vector3d& normal = planes[quadrilaterals[candidate.door].plane].plane.normal;
        const auto level = nearest_axis(axes.axes, normal, settings.angle_tolerance);
        if (!level || level->axis == candidate.up.axis) continue;
        const Vector3d y = level->sign * axes.axes.col(level->axis);
        result.room_from_map.row(0) = y.cross(z).transpose();
        result.room_from_map.row(1) = y.transpose();
        result.room_from_map.row(2) = z.transpose();
        result.stop = DoorOrientationStop::door_found;
        result.num_doors = num_alike;
        result.door = candidate.door;
        result.wall = candidate.wall;
    }
    return result;
}

}  // namespace roomscribe
