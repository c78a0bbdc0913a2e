// SPDX-License-Identifier: MIT
#include "roomscribe/export/wall_openings.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

/// A plane with axes: x level and y up where the plane stands, so that openings are rectangles.
struct PlaneFrame {
    Eigen::Vector3d origin;
    Eigen::Vector3d x;
    Eigen::Vector3d y;

    explicit PlaneFrame(const SpacePolygon& polygon) : origin(polygon.front()) {
        const Eigen::Vector3d normal = area_vector(polygon).normalized();
        const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(normal);
        x = level.norm() > 0.1 ? Eigen::Vector3d(level.normalized()) : normal.unitOrthogonal();
        y = normal.cross(x);
    }
    Eigen::Vector2d down(const Eigen::Vector3d& p) const {
        return {x.dot(p - origin), y.dot(p - origin)};
    }
    Eigen::Vector3d up(const Eigen::Vector2d& p) const { return origin + p.x() * x + p.y() * y; }
    PlanePolygon down(const SpacePolygon& polygon) const {
        PlanePolygon flat;
        for (const Eigen::Vector3d& corner : polygon)
            flat.push_back(down(corner));
        return flat;
    }
    std::vector<SpacePolygon> up(const std::vector<PlanePolygon>& pieces) const {
        std::vector<SpacePolygon> raised;
        for (const PlanePolygon& piece : pieces) {
            SpacePolygon& polygon = raised.emplace_back();
            for (const Eigen::Vector2d& corner : piece)
                polygon.push_back(up(corner));
        }
        return raised;
    }
};

PlaneRectangle bounds(const PlanePolygon& corners) {
    PlaneRectangle rectangle{corners.front(), corners.front()};
    for (const Eigen::Vector2d& corner : corners) {
        rectangle.low = rectangle.low.cwiseMin(corner);
        rectangle.high = rectangle.high.cwiseMax(corner);
    }
    return rectangle;
}

SpacePolygon corners_of(const Wall& wall, const Opening& opening) {
    SpacePolygon corners;
    for (const auto& [station, z] :
         {std::pair{opening.from, opening.bottom}, std::pair{opening.to, opening.bottom},
          std::pair{opening.to, opening.top}, std::pair{opening.from, opening.top}}) {
        const Eigen::Vector2d place = wall.start + station * wall.along();
        corners.emplace_back(place.x(), place.y(), z);
    }
    return corners;
}

bool encloses_area(const SpacePolygon& polygon) {
    return area_vector(polygon).norm() > 1e-9;
}

}  // namespace

PlanePolygon clean_outline(const PlanePolygon& corners) {
    PlanePolygon outline = corners;
    constexpr double same_place = 1e-5;  // the precision that IFC files are written for
    const auto is_same = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return (a - b).norm() < same_place;
    };
    outline.erase(std::unique(outline.begin(), outline.end(), is_same), outline.end());
    while (outline.size() > 1 && is_same(outline.front(), outline.back()))
        outline.pop_back();
    const double area = signed_area(outline);
    if (std::abs(area) < 1e-9) return {};
    if (area < 0.0) std::reverse(outline.begin(), outline.end());
    return outline;
}

double area_of_openings(const Building& building, std::size_t wall_index) {
    const Wall& wall = building.walls[wall_index];
    const PlanePolygon body{{wall.body_from, wall.bottom},
                            {wall.body_to, wall.bottom},
                            {wall.body_to, wall.top},
                            {wall.body_from, wall.top}};
    std::vector<PlaneRectangle> holes;
    for (const Opening& opening : building.openings) {
        if (opening.wall == wall_index)
            holes.push_back({{opening.from, opening.bottom}, {opening.to, opening.top}});
    }
    return signed_area(body) - total_area(without_rectangles({body}, holes));
}

std::vector<SpacePolygon> pieces_of(const SpacePolygon& polygon) {
    if (!encloses_area(polygon)) return {};
    const PlaneFrame frame(polygon);
    return frame.up(convex_pieces(frame.down(polygon)));
}

std::vector<SpacePolygon> pieces_of_face(const Building& building, std::size_t wall_index,
                                         std::size_t face) {
    const Wall& wall = building.walls[wall_index];
    const SpacePolygon& polygon = building.scene.components[wall.faces[face].component].polygon;
    if (!encloses_area(polygon)) return {};
    const PlaneFrame frame(polygon);
    std::vector<PlaneRectangle> holes;
    for (const Opening& opening : building.openings) {
        if (opening.wall == wall_index)
            holes.push_back(bounds(frame.down(corners_of(wall, opening))));
    }
    return frame.up(without_rectangles(convex_pieces(frame.down(polygon)), holes));
}

std::vector<SpacePolygon> pieces_of_frame(const Building& building, const Opening& opening) {
    const SpacePolygon& polygon = building.scene.components[opening.frame.value()].polygon;
    if (!encloses_area(polygon)) return {};
    const PlaneFrame frame(polygon);
    std::vector<PlaneRectangle> holes;
    if (const auto& inside = opening.filling ? opening.filling : opening.passage)
        holes.push_back(bounds(frame.down(building.scene.components[*inside].polygon)));
    return frame.up(without_rectangles(convex_pieces(frame.down(polygon)), holes));
}

std::vector<SpacePolygon> pieces_of_component(const Building& building, std::size_t index) {
    const Component& component = building.scene.components[index];
    for (std::size_t wall = 0; wall < building.walls.size(); ++wall) {
        const auto& faces = building.walls[wall].faces;
        for (std::size_t face = 0; face < faces.size(); ++face)
            if (faces[face].component == index) return pieces_of_face(building, wall, face);
    }
    for (const Opening& opening : building.openings)
        if (opening.frame == index) return pieces_of_frame(building, opening);
    if (component.label == Label::unknown) return {};
    return pieces_of(component.polygon);
}

}  // namespace roomscribe
