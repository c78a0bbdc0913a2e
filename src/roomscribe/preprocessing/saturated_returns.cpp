// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/saturated_returns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

std::vector<std::uint32_t> find_saturated_returns(std::span<const Eigen::Vector3f> positions,
                                                  const Eigen::Vector3d& sensor) {
    // The last two shells of the range, each this share of it thick: 6 cm of 30 m.
    constexpr double shell_thickness = 0.002;
    // Fewer mislead nobody; in a place the shell before the last holds as many as the last.
    constexpr std::size_t min_returns = 100;
    constexpr std::size_t min_ratio = 20;
    // A plane crosses a shell of this thickness within 3.6 degrees of its perpendicular.
    constexpr double max_plane_spread = 7.0 / 180.0 * std::numbers::pi;

    const auto ray_to = [&](std::size_t i) {
        return Eigen::Vector3d(positions[i].cast<double>() - sensor);
    };
    double squared_end = 0.0;
    std::size_t num_returns = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!is_finite(positions[i])) continue;
        squared_end = std::max(squared_end, ray_to(i).squaredNorm());
        ++num_returns;
    }
    const auto lies_within = [&](std::size_t i, double share_of_end) {
        return ray_to(i).squaredNorm() >= share_of_end * share_of_end * squared_end;
    };
    std::vector<std::uint32_t> last;
    std::size_t num_before_last = 0;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (!is_finite(positions[i]) || !lies_within(i, 1.0 - 2.0 * shell_thickness)) continue;
        if (lies_within(i, 1.0 - shell_thickness)) {
            last.push_back(i);
        } else {
            ++num_before_last;
        }
    }
    // More than half: the inside of a dome.
    if (last.size() < std::max(min_returns, min_ratio * num_before_last) ||
        2 * last.size() > num_returns) {
        return {};
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t i : last)
        mean += ray_to(i).normalized();
    mean /= static_cast<double>(last.size());
    // Unit vectors within an angle of their mean have a mean at least as long as its cosine.
    if (mean.norm() >= std::cos(max_plane_spread)) return {};
    return last;
}

}  // namespace roomscribe
