// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

#include <algorithm>
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

}  // namespace

PlanRectangle smallest_rectangle(std::span<const Eigen::Vector2d> places) {
    if (places.empty()) return {};
    const std::vector<Eigen::Vector2d> hull = convex_hull(places);
    const PlanRectangle straight = rectangle_along(places, Eigen::Vector2d::UnitX());
    PlanRectangle smallest = straight;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
        if (edge.norm() < 1e-9) continue;
        const PlanRectangle turned = rectangle_along(hull, edge.normalized());
        if (turned.area() < smallest.area()) smallest = turned;
    }
    constexpr double nearly = 1.1;
    return straight.area() <= nearly * smallest.area() ? straight : smallest;
}

}  // namespace roomscribe
