// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/room_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A line of the plan.
struct PlanLine {
    Vector2d point;
    Vector2d direction;

    Vector2d foot(const Vector2d& place) const {
        return point + direction.dot(place - point) * direction;
    }
};

std::optional<Vector2d> meeting_point(const PlanLine& a, const PlanLine& b) {
    const double sine = cross(a.direction, b.direction);
    if (std::abs(sine) < std::sin(radians(20.0))) return std::nullopt;
    return a.point + cross(b.point - a.point, b.direction) / sine * a.direction;
}

/// Corners that lie within `tolerance` of the line through their neighbours are left out, the least
/// first (Visvalingam and Whyatt 1993 by height instead of area).
void smooth_ring(std::vector<Vector2d>& ring, double tolerance) {
    while (ring.size() > 4) {
        std::size_t flattest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vector2d& before = ring[(i + ring.size() - 1) % ring.size()];
            const Vector2d& after = ring[(i + 1) % ring.size()];
            const double length = (after - before).norm();
            const double height = length > 0.0
                                      ? std::abs(cross(after - before, ring[i] - before)) / length
                                      : (ring[i] - before).norm();
            if (height >= least) continue;
            least = height;
            flattest = i;
        }
        if (least > tolerance) break;
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(flattest));
    }
}

}  // namespace

std::vector<Vector2d> trace_room(const FloorPlan& plan, std::int32_t room) {
    // Edges between cells of the room and others, the room to the left, by their first corner.
    const int width = plan.width();
    const auto is_room = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < width && y < plan.height() &&
               plan.room_of_cell[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(x)] == room;
    };
    using Corner = std::array<int, 2>;
    std::multimap<Corner, Corner> edges;
    for (int y = 0; y < plan.height(); ++y) {
        for (int x = 0; x < width; ++x) {
            if (!is_room(x, y)) continue;
            if (!is_room(x, y - 1)) edges.insert({{x, y}, {x + 1, y}});
            if (!is_room(x + 1, y)) edges.insert({{x + 1, y}, {x + 1, y + 1}});
            if (!is_room(x, y + 1)) edges.insert({{x + 1, y + 1}, {x, y + 1}});
            if (!is_room(x - 1, y)) edges.insert({{x, y + 1}, {x, y}});
        }
    }
    std::vector<Vector2d> best;
    double largest = 0.0;
    const Vector2d low =
        plan.num_cells() > 0
            ? Vector2d(plan.middle_of(0) - Vector2d::Constant(0.5 * plan.cell_size()))
            : Vector2d::Zero();
    while (!edges.empty()) {
        std::vector<Vector2d> ring;
        auto edge = edges.begin();
        while (edge != edges.end()) {
            ring.emplace_back(low + plan.cell_size() * Vector2d(edge->first[0], edge->first[1]));
            const Corner next = edge->second;
            edges.erase(edge);
            edge = edges.find(next);
        }
        const double area = signed_area(ring);
        if (area <= largest) continue;
        largest = area;
        best = std::move(ring);
    }
    smooth_ring(best, 1.5 * plan.cell_size());
    return best;
}

void fill_to_walls(FloorPlan& plan, std::span<const WallFace> faces,
                   const Eigen::Matrix3d& room_from_map) {
    constexpr double max_depth = 2.0;  // beds
    const double step = 0.5 * plan.cell_size();
    std::vector<std::size_t> hidden;
    for (const WallFace& face : faces) {
        const Vector2d inwards = (room_from_map * face.plane.normal).head<2>();
        for (double along = face.start; along <= face.end; along += step) {
            const Vector3d foot = face.plane.offset * face.plane.normal + along * face.along;
            const Vector2d place = (room_from_map * foot).head<2>();
            hidden.clear();
            for (double depth = step; depth <= max_depth; depth += step) {
                const auto cell = plan.cell_at(place + depth * inwards);
                if (!cell) break;
                const std::int32_t room = plan.room_of_cell[*cell];
                if (room == face.room) {
                    for (const std::size_t behind : hidden)
                        plan.room_of_cell[behind] = room;
                    break;
                }
                // The wall's own line of cells may be another's that lies behind it.
                if (room != no_room && depth > 2.0 * plan.cell_size()) break;
                if (room == no_room) hidden.push_back(*cell);
            }
        }
    }
}

std::vector<Vector2d> outline_between_walls(std::span<const Vector2d> outline,
                                            std::span<const WallFace> faces, std::int32_t room,
                                            const Eigen::Matrix3d& room_from_map) {
    constexpr double reach = 0.2;
    const auto flat = [&](const Vector3d& vector) -> Vector2d {
        return (room_from_map * vector).head<2>();
    };
    struct Edge {
        PlanLine line;
        const WallFace* face;
        Vector2d start;
        bool is_dent = false;
    };
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vector2d& a = outline[i];
        const Vector2d& b = outline[(i + 1) % outline.size()];
        const Vector2d direction = (b - a).normalized();
        Edge edge{{a, direction}, nullptr, a};
        double nearest = reach;
        for (const WallFace& face : faces) {
            const Vector2d along = flat(face.along);
            if (face.room != room || std::abs(along.dot(direction)) < std::cos(radians(15.0)))
                continue;
            const PlanLine line{flat(face.plane.offset * face.plane.normal), along};
            const Vector2d middle = 0.5 * (a + b);
            const double distance = (line.foot(middle) - middle).norm();
            const double position = along.dot(middle);
            if (distance > nearest || position < face.start - reach || position > face.end + reach)
                continue;
            nearest = distance;
            edge.face = &face;
            edge.line = {line.foot(a), along.dot(direction) < 0.0 ? Vector2d(-along) : along};
        }
        if (!edges.empty() && edge.face != nullptr && edges.back().face == edge.face) continue;
        edges.push_back(edge);
    }
    while (edges.size() > 1 && edges.front().face != nullptr &&
           edges.front().face == edges.back().face) {
        edges.pop_back();
    }
    // What stands before a wall hides the strip behind it: between two edges on one wall it is
    // the wall that counts.
    constexpr std::size_t max_dent = 8;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].face == nullptr) continue;
        for (std::size_t count = 1; count <= max_dent && count + 3 < edges.size(); ++count) {
            const std::size_t next = (i + count) % edges.size();
            if (edges[next].face == nullptr) continue;
            if (edges[next].face != edges[i].face) break;
            for (std::size_t k = 1; k <= count; ++k) {
                Edge& dent = edges[(i + k) % edges.size()];
                dent.face = edges[i].face;
                dent.is_dent = true;
            }
            break;
        }
    }
    std::erase_if(edges, [](const Edge& edge) { return edge.is_dent; });
    std::vector<Vector2d> corners;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& before = edges[(i + edges.size() - 1) % edges.size()];
        const Edge& after = edges[i];
        const auto corner = meeting_point(before.line, after.line);
        const bool is_near = corner && (*corner - after.start).norm() <= 5.0 * reach;
        if (is_near) {
            corners.push_back(*corner);
        } else {
            corners.push_back(before.line.foot(after.start));
            corners.push_back(after.line.foot(after.start));
        }
    }
    return corners;
}

}  // namespace roomscribe
