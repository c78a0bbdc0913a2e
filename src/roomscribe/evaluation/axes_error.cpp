// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/axes_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomscribe {

AxesError compare_axes(const Transform& true_room_from_map,
                       const Transform& predicted_room_from_map) {
    const Eigen::Matrix3d true_from_predicted =
        true_room_from_map.linear() * predicted_room_from_map.linear().transpose();
    const Eigen::Vector3d up = true_from_predicted.col(2);
    AxesError error;
    error.up = std::atan2(up.head<2>().norm(), up.z());

    const Eigen::Vector2d x = true_from_predicted.col(0).head<2>();
    const Eigen::Vector2d y = true_from_predicted.col(1).head<2>();
    const Eigen::Vector2d seen = x.norm() >= y.norm() ? x : y;
    constexpr double quarter = 0.5 * std::numbers::pi;
    const double turn = std::fmod(std::abs(std::atan2(seen.y(), seen.x())), quarter);
    error.horizontal = std::min(turn, quarter - turn);
    return error;
}

}  // namespace roomscribe
