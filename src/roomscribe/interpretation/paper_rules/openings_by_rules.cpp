// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/paper_rules/openings_by_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// m before the wall. What hides a wall stands no further off: wardrobes are up to 0.6 m deep.
constexpr double max_hiding_distance = 0.6;
/// A window may have a plant before it, a picture or a cupboard hides all of it.
constexpr double max_hidden_share = 0.1;

bool is_about(double value, double expected, double tolerance) {
    return std::abs(value - expected) <= tolerance * expected;
}

WallRectangle overlap(const WallRectangle& a, const WallRectangle& b) {
    return {std::max(a.start, b.start), std::min(a.end, b.end), std::max(a.bottom, b.bottom),
            std::min(a.top, b.top)};
}

bool overlaps(const WallRectangle& a, const WallRectangle& b) {
    const WallRectangle shared = overlap(a, b);
    return shared.width() > 0.0 && shared.height() > 0.0;
}

/// The quadrilateral as a rectangle on the wall, if it lies there upright.
std::optional<RuleRectangle> place_on_wall(const PlaneQuadrilateral& quadrilateral,
                                           std::span<const PlanarPatch> planes,
                                           const RuleWall& wall, const Vector3d& up,
                                           double plane_tolerance,
                                           const PaperRulesSettings& settings) {
    const double min_cosine = std::cos(settings.angle_tolerance);
    const Quadrilateral& quad = quadrilateral.quadrilateral;
    const Vector3d side = (quad.corners[1] - quad.corners[0]).normalized();
    if (std::abs(planes[quadrilateral.plane].plane.normal.dot(wall.face.normal)) < min_cosine ||
        std::max(std::abs(side.dot(up)), std::abs(side.dot(wall.along))) < min_cosine) {
        return std::nullopt;
    }
    RuleRectangle result;
    result.depth = -wall.face.signed_distance(quad.center());
    if (result.depth < -plane_tolerance || result.depth > settings.wall_depth) return std::nullopt;
    std::array<double, 4> along{};
    std::array<double, 4> height{};
    for (std::size_t i = 0; i < 4; ++i) {
        along[i] = quad.corners[i].dot(wall.along);
        height[i] = quad.corners[i].dot(up);
    }
    std::sort(along.begin(), along.end());
    std::sort(height.begin(), height.end());
    result.extent = {0.5 * (along[0] + along[1]), 0.5 * (along[2] + along[3]),
                     0.5 * (height[0] + height[1]), 0.5 * (height[2] + height[3])};
    // A cupboard's side or another room's door is not within this wall.
    const double middle = 0.5 * (result.extent.start + result.extent.end);
    if (middle < wall.extent.start || middle > wall.extent.end) return std::nullopt;
    return result;
}

bool is_door(const WallRectangle& rectangle, const RuleWall& wall,
             const PaperRulesSettings& settings) {
    return is_about(rectangle.width(), settings.door_width, settings.size_tolerance) &&
           is_about(rectangle.height(), settings.door_height, settings.size_tolerance) &&
           std::abs(rectangle.bottom - wall.extent.bottom) <= settings.edge_distance;
}

/// Share of the wall behind the rectangle that what lies before the wall would cover.
double hidden_share(const PointCloud& map, std::span<const PlanarPatch> planes,
                    const RuleWall& wall, const RuleRectangle& rectangle, const Vector3d& up,
                    double plane_tolerance) {
    const double density = static_cast<double>(planes[wall.plane].points.size()) /
                           std::max(planes[wall.plane].area, 1e-6);
    std::size_t count = 0;
    for (const Eigen::Vector3f& position : map.positions) {
        const Vector3d point = position.cast<double>();
        const double before = wall.face.signed_distance(point);
        if (!(before > plane_tolerance && before < max_hiding_distance)) continue;
        const double along = point.dot(wall.along);
        const double height = point.dot(up);
        count += along > rectangle.extent.start && along < rectangle.extent.end &&
                 height > rectangle.extent.bottom && height < rectangle.extent.top;
    }
    return static_cast<double>(count) / (density * rectangle.extent.area());
}

/// By size and place alone.
bool may_be_window(const WallRectangle& rectangle, const RuleWall& wall,
                   const PaperRulesSettings& settings) {
    const auto has_size = [&](double width, double height) {
        return is_about(width, settings.window_width, settings.size_tolerance) &&
               is_about(height, settings.window_height, settings.size_tolerance);
    };
    const bool is_closer_to_ceiling =
        rectangle.bottom - wall.extent.bottom > wall.extent.top - rectangle.top;
    return is_closer_to_ceiling && (has_size(rectangle.width(), rectangle.height()) ||
                                    has_size(rectangle.height(), rectangle.width()));
}

/// The largest rectangle around another one.
std::optional<RuleRectangle> find_frame(const RuleRectangle& leaf,
                                        std::span<const RuleRectangle> rectangles,
                                        const PaperRulesSettings& settings) {
    // Two lines of one rim are as near to each other as the ends of the segments of a shape.
    const double slack = 0.2 * settings.frame_width;
    std::optional<RuleRectangle> frame;
    for (const RuleRectangle& other : rectangles) {
        const WallRectangle& a = leaf.extent;
        const WallRectangle& b = other.extent;
        const std::array<double, 4> widths{a.start - b.start, b.end - a.end, a.bottom - b.bottom,
                                           b.top - a.top};
        const auto is_frame_width = [&](double width) {
            return width >= -slack && width <= settings.frame_width;
        };
        if (!std::all_of(widths.begin(), widths.end(), is_frame_width) || b.area() <= a.area())
            continue;
        if (!frame || b.area() > frame->extent.area()) frame = other;
    }
    return frame;
}

}  // namespace

std::vector<RuleOpening> find_openings_by_rules(const PointCloud& map,
                                                std::span<const PlanarPatch> planes,
                                                std::span<const PlaneQuadrilateral> quadrilaterals,
                                                const RuleRoom& room, const Vector3d& up,
                                                double plane_tolerance,
                                                const PaperRulesSettings& settings) {
    check_settings(settings);
    std::vector<RuleOpening> openings;
    for (std::size_t number = 0; number < room.walls.size(); ++number) {
        const RuleWall& wall = room.walls[number];
        std::vector<RuleRectangle> rectangles;
        for (const PlaneQuadrilateral& quadrilateral : quadrilaterals) {
            const auto placed =
                place_on_wall(quadrilateral, planes, wall, up, plane_tolerance, settings);
            if (placed) rectangles.push_back(*placed);
        }
        std::stable_sort(rectangles.begin(), rectangles.end(),
                         [](const RuleRectangle& a, const RuleRectangle& b) {
                             return a.extent.area() < b.extent.area();
                         });
        const std::size_t first = openings.size();
        for (const RuleRectangle& rectangle : rectangles) {
            const bool is_taken =
                std::any_of(openings.begin() + static_cast<std::ptrdiff_t>(first), openings.end(),
                            [&](const RuleOpening& other) {
                                return overlaps(other.leaf.extent, rectangle.extent);
                            });
            if (is_taken) continue;
            RuleOpening opening{OpeningType::door, number, rectangle, std::nullopt};
            if (!is_door(rectangle.extent, wall, settings)) {
                if (!may_be_window(rectangle.extent, wall, settings) ||
                    hidden_share(map, planes, wall, rectangle, up, plane_tolerance) >
                        max_hidden_share) {
                    continue;
                }
                opening.type = OpeningType::window;
            }
            opening.frame = find_frame(rectangle, rectangles, settings);
            openings.push_back(opening);
        }
    }
    return openings;
}

}  // namespace roomscribe
