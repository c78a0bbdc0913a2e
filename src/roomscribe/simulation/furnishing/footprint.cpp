// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/footprint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

std::array<Vector2d, 4> corners_of(const Footprint& f) {
    return {f.corner(-1, -1), f.corner(1, -1), f.corner(1, 1), f.corner(-1, 1)};
}

/// True if a line along one of the axes of `a` keeps the points apart from it.
bool is_apart(const Footprint& a, std::span<const Vector2d> points, double margin) {
    const std::array axes{a.axis, Vector2d(-a.axis.y(), a.axis.x())};
    for (int i = 0; i < 2; ++i) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const Vector2d& point : points) {
            const double t = (point - a.center).dot(axes[static_cast<std::size_t>(i)]);
            low = std::min(low, t);
            high = std::max(high, t);
        }
        if (low > a.half[i] + margin || high < -a.half[i] - margin) return true;
    }
    return false;
}

}  // namespace

double Footprint::distance(const Vector2d& point) const {
    const Vector2d offset = point - center;
    const double x = std::max(0.0, std::abs(offset.dot(axis)) - half.x());
    const double y = std::max(0.0, std::abs(cross(axis, offset)) - half.y());
    return std::hypot(x, y);
}

Footprint footprint_of(const ItemPlan& item, const Eigen::AlignedBox3d& extent) {
    const double turn = radians(item.turn);
    const Vector2d front(std::cos(turn), std::sin(turn));
    const Vector2d left(-front.y(), front.x());
    const Eigen::Vector3d middle = extent.center();
    return {.center = item.at + middle.x() * front + middle.y() * left,
            .axis = front,
            .half = extent.sizes().head<2>() / 2.0,
            .low = item.elevation + extent.min().z(),
            .high = item.elevation + extent.max().z()};
}

Footprint before_wall(const BuiltWallFace& wall, double low, double high, double depth) {
    return {.center = wall.start + (low + high) / 2.0 * wall.along() + depth / 2.0 * wall.inward(),
            .axis = wall.along(),
            .half = {(high - low) / 2.0, depth / 2.0},
            .low = 0.0,
            .high = 0.0};
}

bool touches(const BuiltWallFace& face, const Footprint& footprint, double margin) {
    const std::array ends{face.start, face.end};
    if (is_apart(footprint, ends, margin)) return false;
    const Vector2d inward = face.inward();
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vector2d& corner : corners_of(footprint)) {
        const double t = (corner - face.start).dot(inward);
        low = std::min(low, t);
        high = std::max(high, t);
    }
    return low < margin && high > -margin;
}

bool overlap(const Footprint& a, const Footprint& b, double margin) {
    if (a.low > b.high || b.low > a.high) return false;
    if ((a.center - b.center).norm() > a.half.norm() + b.half.norm() + margin) return false;
    return !is_apart(a, corners_of(b), margin) && !is_apart(b, corners_of(a), margin);
}

}  // namespace roomscribe
