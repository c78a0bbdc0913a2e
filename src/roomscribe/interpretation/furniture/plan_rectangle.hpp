// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>

#include <Eigen/Core>

namespace roomscribe {

/// A rectangle as seen from above, turned in any way. In metres, in the frame that the places are
/// given in. Of no size for no places.
struct PlanRectangle {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< unit vector along the longer side
    double length = 0.0;                              ///< along `axis`
    double width = 0.0;                               ///< across it, not more than `length`

    Eigen::Vector2d across() const { return {-axis.y(), axis.x()}; }
    double area() const { return length * width; }
    /// How far outside a place lies, along the axis that it lies farther out on; negative within.
    double distance(const Eigen::Vector2d& place) const {
        const Eigen::Vector2d from_center = place - center;
        return std::max(std::abs(from_center.dot(axis)) - length / 2.0,
                        std::abs(from_center.dot(across())) - width / 2.0);
    }
};

/// The smallest rectangle around the places; of those nearly as small (a tenth more area) the one
/// along x and y, for most pieces stand along the walls, unless the places lie much nearer to the
/// edges of another, as those of two sides of a box do.
PlanRectangle smallest_rectangle(std::span<const Eigen::Vector2d> places);

}  // namespace roomscribe
