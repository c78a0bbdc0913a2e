// SPDX-License-Identifier: MIT
#include "roomscribe/export/planar_pieces.hpp"

#include <algorithm>
#include <utility>

#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

/// m2: a square of 10 micrometres, below what files tell apart.
constexpr double no_area = 1e-10;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return cross(b - a, c - a);
}

bool is_convex(const PlanePolygon& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t n = corners.size();
        if (turn(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]) < 0.0) return false;
    }
    return true;
}

/// Whether the corner at `tip` can be cut off: it bends outwards and no other corner lies in it.
bool is_ear(const PlanePolygon& corners, std::size_t tip) {
    const std::size_t n = corners.size();
    const Eigen::Vector2d& a = corners[(tip + n - 1) % n];
    const Eigen::Vector2d& b = corners[tip];
    const Eigen::Vector2d& c = corners[(tip + 1) % n];
    if (turn(a, b, c) < 0.0) return false;
    return std::none_of(corners.begin(), corners.end(), [&](const Eigen::Vector2d& p) {
        if (p == a || p == b || p == c) return false;
        return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
    });
}

std::vector<PlanePolygon> triangles(PlanePolygon corners) {
    std::vector<PlanePolygon> pieces;
    while (corners.size() >= 3) {
        std::size_t tip = 0;
        while (tip < corners.size() && !is_ear(corners, tip))
            ++tip;
        if (tip == corners.size()) break;
        const std::size_t n = corners.size();
        PlanePolygon ear{corners[(tip + n - 1) % n], corners[tip], corners[(tip + 1) % n]};
        if (signed_area(ear) > no_area) pieces.push_back(std::move(ear));
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(tip));
    }
    return pieces;
}

/// The part of a convex piece on one side of a line along an axis: where sign * x <= sign * limit.
PlanePolygon clip(const PlanePolygon& piece, Eigen::Index axis, double sign, double limit) {
    PlanePolygon kept;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Eigen::Vector2d& a = piece[i];
        const Eigen::Vector2d& b = piece[(i + 1) % piece.size()];
        const double from = sign * (a(axis) - limit);
        const double to = sign * (b(axis) - limit);
        if (from <= 0.0) kept.push_back(a);
        if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
            Eigen::Vector2d crossing = a + from / (from - to) * (b - a);
            crossing(axis) = limit;
            kept.push_back(crossing);
        }
    }
    return kept;
}

void keep(PlanePolygon piece, std::vector<PlanePolygon>& pieces) {
    if (piece.size() >= 3 && signed_area(piece) > no_area) pieces.push_back(std::move(piece));
}

/// Left of the rectangle, right of it, below and above it.
void cut_out(PlanePolygon piece, const PlaneRectangle& rectangle,
             std::vector<PlanePolygon>& pieces) {
    for (const Eigen::Index axis : {0, 1}) {
        keep(clip(piece, axis, 1.0, rectangle.low(axis)), pieces);
        keep(clip(piece, axis, -1.0, rectangle.high(axis)), pieces);
        piece = clip(clip(piece, axis, -1.0, rectangle.low(axis)), axis, 1.0, rectangle.high(axis));
    }
}

}  // namespace

std::vector<PlanePolygon> convex_pieces(std::span<const Eigen::Vector2d> corners) {
    PlanePolygon polygon(corners.begin(), corners.end());
    polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
    if (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
    const double area = signed_area(polygon);
    if (std::abs(area) <= no_area) return {};
    if (area < 0.0) std::reverse(polygon.begin(), polygon.end());
    if (is_convex(polygon)) return {polygon};
    return triangles(std::move(polygon));
}

std::vector<PlanePolygon> without_rectangles(std::vector<PlanePolygon> pieces,
                                             std::span<const PlaneRectangle> rectangles) {
    for (const PlaneRectangle& rectangle : rectangles) {
        if ((rectangle.high.array() <= rectangle.low.array()).any()) continue;
        std::vector<PlanePolygon> left;
        for (PlanePolygon& piece : pieces) {
            const bool is_apart =
                std::all_of(piece.begin(), piece.end(),
                            [&](const auto& p) { return p.x() <= rectangle.low.x(); }) ||
                std::all_of(piece.begin(), piece.end(),
                            [&](const auto& p) { return p.x() >= rectangle.high.x(); }) ||
                std::all_of(piece.begin(), piece.end(),
                            [&](const auto& p) { return p.y() <= rectangle.low.y(); }) ||
                std::all_of(piece.begin(), piece.end(),
                            [&](const auto& p) { return p.y() >= rectangle.high.y(); });
            if (is_apart) {
                left.push_back(std::move(piece));
            } else {
                cut_out(std::move(piece), rectangle, left);
            }
        }
        pieces = std::move(left);
    }
    return pieces;
}

double total_area(std::span<const PlanePolygon> pieces) {
    double area = 0.0;
    for (const PlanePolygon& piece : pieces)
        area += signed_area(piece);
    return area;
}

}  // namespace roomscribe
