// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe::test {

/// A rectangle sampled every `step`, with its normal and Gaussian noise along it. `relief` says how
/// far it stands out at (along u, along v).
inline void add_rectangle(
    PointCloud& cloud, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
    const Eigen::Vector3d& v, double step, double noise, Random& random,
    const std::function<double(double, double)>& relief = [](double, double) { return 0.0; }) {
    const Eigen::Vector3d normal = u.cross(v).normalized();
    for (double a = 0.5 * step; a < u.norm(); a += step) {
        for (double b = 0.5 * step; b < v.norm(); b += step) {
            const Eigen::Vector3d point = corner + a * u.normalized() + b * v.normalized() +
                                          (relief(a, b) + noise * random.normal()) * normal;
            cloud.positions.push_back(point.cast<float>());
            cloud.normals.push_back(normal.cast<float>());
        }
    }
}

inline bool is_within(double value, double low, double high) {
    return value >= low && value <= high;
}

}  // namespace roomscribe::test
