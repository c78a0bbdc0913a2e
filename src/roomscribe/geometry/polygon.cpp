// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/polygon.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace roomscribe {
namespace {

/// Twice the area of the triangle, positive when its corners run counter-clockwise.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return cross(b - a, c - a);
}

}  // namespace

std::vector<Eigen::Vector2d> convex_hull(std::span<const Eigen::Vector2d> points) {
    std::vector<Eigen::Vector2d> sorted(points.begin(), points.end());
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
        return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    });
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    if (sorted.size() < 3) return sorted;

    std::vector<Eigen::Vector2d> hull;
    const auto add_chain = [&hull](auto begin, auto end) {
        const std::size_t start = hull.size();
        for (auto point = begin; point != end; ++point) {
            while (hull.size() >= start + 2 &&
                   turn(hull[hull.size() - 2], hull.back(), *point) <= 0.0) {
                hull.pop_back();
            }
            hull.push_back(*point);
        }
        hull.pop_back();  // the other chain starts with it
    };
    add_chain(sorted.begin(), sorted.end());
    add_chain(sorted.rbegin(), sorted.rend());
    return hull;
}

double signed_area(std::span<const Eigen::Vector2d> corners) {
    double twice_area = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d& a = corners[i];
        const Eigen::Vector2d& b = corners[(i + 1) % corners.size()];
        twice_area += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice_area;
}

Eigen::Vector3d area_vector(std::span<const Eigen::Vector3d> corners) {
    Eigen::Vector3d twice_area = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        twice_area += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    return 0.5 * twice_area;
}

bool is_inside(std::span<const Eigen::Vector2d> corners, const Eigen::Vector2d& place) {
    bool inside = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d a = corners[i] - place;
        const Eigen::Vector2d b = corners[(i + 1) % corners.size()] - place;
        if ((a.y() > 0.0) != (b.y() > 0.0) && (cross(a, b) > 0.0) == (b.y() > a.y()))
            inside = !inside;
    }
    return inside;
}

}  // namespace roomscribe
