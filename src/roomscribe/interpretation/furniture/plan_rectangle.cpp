// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

PlanRectangle rectangle_along(std::span<const Eigen::Vector2d> places,
                              const Eigen::Vector2d& direction) {
    const Eigen::Vector2d across(-direction.y(), direction.x());
    Eigen::Vector2d low(places[0].dot(direction), places[0].dot(across));
    Eigen::Vector2d high = low;
    for (const Eigen::Vector2d& place : places) {
        const Eigen::Vector2d turned(place.dot(direction), place.dot(across));
        low = low.cwiseMin(turned);
        high = high.cwiseMax(turned);
    }
    const Eigen::Vector2d middle = 0.5 * (low + high);
    const Eigen::Vector2d size = high - low;
    PlanRectangle result;
    result.center = middle.x() * direction + middle.y() * across;
    result.axis = size.x() >= size.y() ? direction : across;
    result.length = size.maxCoeff();
    result.width = size.minCoeff();
    return result;
}

/// Mean distance of places within a rectangle to its nearest edge.
double distance_to_edges(std::span<const Eigen::Vector2d> places, const PlanRectangle& rectangle) {
    const Eigen::Vector2d across = rectangle.across();
    double sum = 0.0;
    for (const Eigen::Vector2d& place : places) {
        const Eigen::Vector2d from_center = place - rectangle.center;
        sum += std::min(0.5 * rectangle.length - std::abs(from_center.dot(rectangle.axis)),
                        0.5 * rectangle.width - std::abs(from_center.dot(across)));
    }
    return sum / static_cast<double>(places.size());
}

}  // namespace

PlanRectangle smallest_rectangle(std::span<const Eigen::Vector2d> places) {
    if (places.empty()) return {};
    const std::vector<Eigen::Vector2d> hull = convex_hull(places);
    const PlanRectangle straight = rectangle_along(places, Eigen::Vector2d::UnitX());
    std::vector<PlanRectangle> turned{straight};
    double smallest = straight.area();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
        if (edge.norm() < 1e-9) continue;
        turned.push_back(rectangle_along(hull, edge.normalized()));
        smallest = std::min(smallest, turned.back().area());
    }
    // Two sides of a box fill half of its rectangle, and half of the one along the diagonal, to the
    // last bit: of those that are as small, the one whose edges the places lie on.
    constexpr double nearly = 1.1;
    constexpr double as_near = 1.5;
    constexpr double rounding = 1e-9;
    const PlanRectangle* best = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlanRectangle& rectangle : turned) {
        if (rectangle.area() > nearly * smallest + rounding) continue;
        const double distance = distance_to_edges(places, rectangle);
        const bool is_straight = best == turned.data();
        if (best && distance * (is_straight ? as_near : 1.0) >= nearest) continue;
        nearest = distance;
        best = &rectangle;
    }
    return *best;
}

}  // namespace roomscribe
