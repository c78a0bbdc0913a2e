// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/polygon_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Corners = std::vector<Eigen::Vector2d>;
using Triangle = std::array<Eigen::Vector2d, 3>;

/// What of a convex polygon lies to the left of the line from `start` to `end`.
Corners clip(const Corners& polygon, const Eigen::Vector2d& start, const Eigen::Vector2d& end) {
    const auto side = [&](const Eigen::Vector2d& point) {
        return cross(end - start, point - start);
    };
    Corners clipped;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& from = polygon[i];
        const Eigen::Vector2d& to = polygon[(i + 1) % polygon.size()];
        const double from_side = side(from);
        const double to_side = side(to);
        if (from_side >= 0.0) clipped.push_back(from);
        if ((from_side < 0.0) != (to_side < 0.0))
            clipped.emplace_back(from + from_side / (from_side - to_side) * (to - from));
    }
    return clipped;
}

/// Both triangles run counter-clockwise.
double overlap_of(const Triangle& a, const Triangle& b) {
    Corners shared(a.begin(), a.end());
    for (std::size_t i = 0; i < 3 && !shared.empty(); ++i)
        shared = clip(shared, b[i], b[(i + 1) % 3]);
    return signed_area(shared);
}

struct SignedTriangle {
    Triangle corners;  ///< counter-clockwise
    double sign = 1.0;
};

/// The sum of the signed triangles is 1 inside of the polygon and 0 outside.
std::vector<SignedTriangle> fan(std::span<const Eigen::Vector2d> polygon) {
    const double turn = signed_area(polygon) < 0.0 ? -1.0 : 1.0;
    std::vector<SignedTriangle> triangles;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        SignedTriangle triangle{{polygon[0], polygon[i - 1], polygon[i]}, turn};
        const double area = signed_area(triangle.corners);
        if (area == 0.0) continue;
        if (area < 0.0) {
            std::swap(triangle.corners[1], triangle.corners[2]);
            triangle.sign = -turn;
        }
        triangles.push_back(triangle);
    }
    return triangles;
}

}  // namespace

double overlap_area(std::span<const Eigen::Vector2d> a, std::span<const Eigen::Vector2d> b) {
    const std::vector<SignedTriangle> triangles_of_b = fan(b);
    double area = 0.0;
    for (const SignedTriangle& of_a : fan(a)) {
        for (const SignedTriangle& of_b : triangles_of_b)
            area += of_a.sign * of_b.sign * overlap_of(of_a.corners, of_b.corners);
    }
    return std::max(0.0, area);
}

double polygon_iou(std::span<const Eigen::Vector2d> a, std::span<const Eigen::Vector2d> b) {
    const double shared = overlap_area(a, b);
    const double together = std::abs(signed_area(a)) + std::abs(signed_area(b)) - shared;
    return together > 0.0 ? std::clamp(shared / together, 0.0, 1.0) : 0.0;
}

}  // namespace roomscribe
