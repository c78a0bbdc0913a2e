// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scanner_up.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "roomscribe/core/units.hpp"

namespace roomscribe {

UsualUp usual_up(std::span<const Eigen::Vector3f> positions) {
    struct CameraFrame {
        Eigen::Vector3f view;
        Eigen::Vector3d up;
    };
    const std::array<CameraFrame, 3> frames{
        CameraFrame{Eigen::Vector3f::UnitZ(), -Eigen::Vector3d::UnitY()},
        CameraFrame{-Eigen::Vector3f::UnitZ(), Eigen::Vector3d::UnitY()},
        CameraFrame{Eigen::Vector3f::UnitX(), Eigen::Vector3d::UnitZ()}};
    const auto min_cosine = static_cast<float>(std::cos(radians(60.0)));
    for (const CameraFrame& frame : frames) {
        std::size_t num_points = 0;
        const bool sees_all =
            std::all_of(positions.begin(), positions.end(), [&](const Eigen::Vector3f& point) {
                if (!point.allFinite()) return true;
                ++num_points;
                return point.dot(frame.view) >= min_cosine * point.norm();
            });
        if (sees_all && num_points > 0) return {frame.up, true};
    }
    return {};
}

Eigen::Vector3d common_up(std::span<const UsualUp> ups) {
    if (ups.empty()) return Eigen::Vector3d::Zero();
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    bool are_cameras = true;
    for (const UsualUp& each : ups) {
        mean += each.up / static_cast<double>(ups.size());
        are_cameras = are_cameras && each.is_camera;
    }
    // Of unit vectors that are each 30 degrees off their mean.
    if (mean.norm() < std::cos(radians(30.0))) return Eigen::Vector3d::Zero();
    const double trust = are_cameras ? 1.0 : ups.size() > 1 ? 0.5 : 0.25;
    return trust * mean.normalized();
}

}  // namespace roomscribe
