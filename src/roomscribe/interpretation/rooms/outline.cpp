// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Vector2 = Eigen::Vector2d;
using Cell = std::pair<std::int64_t, std::int64_t>;

Cell cell_of(const Vector2& point, double size) {
    return {static_cast<std::int64_t>(std::floor(point.x() / size)),
            static_cast<std::int64_t>(std::floor(point.y() / size))};
}

double side(const Vector2& a, const Vector2& b, const Vector2& point) {
    return cross(b - a, point - a);
}

/// Whether the segments have a point in common; touching counts.
bool segments_meet(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d) {
    return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

bool is_in_triangle(const Vector2& point, const Vector2& a, const Vector2& b, const Vector2& c) {
    const double ab = side(a, b, point);
    const double bc = side(b, c, point);
    const double ca = side(c, a, point);
    return (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
}

class Digger {
  public:
    Digger(std::vector<Vector2> hull, std::vector<Vector2> candidates)
        : ring_(std::move(hull)), candidates_(std::move(candidates)) {}

    void dig(double max_edge);
    void simplify(double tolerance);
    std::vector<Vector2> take() && { return std::move(ring_); }

  private:
    const Vector2& corner(std::size_t i) const { return ring_[i % ring_.size()]; }
    bool crosses_ring(std::size_t edge, const Vector2& point) const;
    bool bend(std::size_t edge);

    std::vector<Vector2> ring_;
    std::vector<Vector2> candidates_;
};

/// Whether the two edges that would take an edge's place meet any other edge.
bool Digger::crosses_ring(std::size_t edge, const Vector2& point) const {
    const Vector2& a = corner(edge);
    const Vector2& b = corner(edge + 1);
    const std::size_t count = ring_.size();
    for (std::size_t k = 1; k < count; ++k) {
        const std::size_t other = (edge + k) % count;
        const Vector2& c = corner(other);
        const Vector2& d = corner(other + 1);
        // The next edge starts at b, the previous one ends at a.
        if (k != 1 && segments_meet(point, b, c, d)) return true;
        if (k + 1 != count && segments_meet(a, point, c, d)) return true;
        if (k == 1 && is_in_triangle(d, a, b, point)) return true;
        if (k + 1 == count && is_in_triangle(c, a, b, point)) return true;
    }
    return false;
}

/// The point that is seen from both ends at the least angle to the edge: the triangle over the edge
/// holds no other.
bool Digger::bend(std::size_t edge) {
    const Vector2 a = corner(edge);
    const Vector2 b = corner(edge + 1);
    const double length = (b - a).norm();
    const Vector2 along = (b - a) / length;
    const Vector2* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Vector2& point : candidates_) {
        const double position = along.dot(point - a);
        const double height = cross(along, point - a);
        if (height <= 0.0 || position <= 0.0 || position >= length) continue;
        const double slope = height / std::min(position, length - position);
        if (slope >= least) continue;
        least = slope;
        best = &point;
    }
    if (best == nullptr || crosses_ring(edge, *best)) return false;
    ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(edge) + 1, *best);
    return true;
}

void Digger::dig(double max_edge) {
    for (std::size_t edge = 0; edge < ring_.size();) {
        const bool is_long = (corner(edge + 1) - corner(edge)).norm() > max_edge;
        if (!is_long || !bend(edge)) ++edge;
    }
}

void Digger::simplify(double tolerance) {
    const auto is_needless = [&](std::size_t i, double limit) {
        const Vector2& before = corner(i + ring_.size() - 1);
        const Vector2& after = corner(i + 1);
        const double length = (after - before).norm();
        if (std::abs(side(before, after, ring_[i])) > limit * length) return false;
        for (std::size_t k = 2; k + 1 < ring_.size(); ++k) {
            if (is_in_triangle(corner(i + k), before, ring_[i], after)) return false;
        }
        return true;
    };
    // Finer first, so that a round corner does not wander off step by step.
    for (const double share : {0.125, 0.25, 0.5, 1.0}) {
        for (std::size_t i = 0; i < ring_.size() && ring_.size() > 3;) {
            if (is_needless(i, share * tolerance)) {
                ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(i));
            } else {
                ++i;
            }
        }
    }
}

/// One point per square of a grid, for where the others would make no difference.
std::vector<Eigen::Vector2d> thin_points(std::span<const Eigen::Vector2d> points,
                                         double cell_size) {
    std::vector<std::pair<Cell, std::uint32_t>> cells;
    cells.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
        cells.emplace_back(cell_of(points[i], cell_size), i);
    std::sort(cells.begin(), cells.end());
    std::vector<Eigen::Vector2d> result;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i == 0 || cells[i].first != cells[i - 1].first)
            result.push_back(points[cells[i].second]);
    }
    return result;
}

}  // namespace

std::vector<Eigen::Vector2d> concave_outline(std::span<const Eigen::Vector2d> points,
                                             double max_edge, double tolerance) {
    std::vector<Vector2> hull = convex_hull(points);
    if (hull.size() < 3) return hull;
    Digger digger(std::move(hull), thin_points(points, std::max(0.1 * max_edge, 1e-6)));
    digger.dig(max_edge);
    digger.simplify(tolerance);
    return std::move(digger).take();
}

}  // namespace roomscribe
