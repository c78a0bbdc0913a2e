// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scanner_up.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "roomscribe/core/units.hpp"

namespace roomscribe {

UsualUp usual_up(std::span<const Eigen::Vector3f> positions, const Eigen::Vector3d& sensor,
                 const Eigen::Matrix3d& axes) {
    constexpr std::size_t enough = 5000;
    const Eigen::Vector3f origin = sensor.cast<float>();
    std::vector<Eigen::Vector3f> directions;
    for (std::size_t i = 0; i < positions.size(); i += 1 + positions.size() / enough) {
        if (positions[i].allFinite()) directions.push_back((positions[i] - origin).normalized());
    }
    struct CameraFrame {
        Eigen::Vector3d view;
        Eigen::Vector3d up;
    };
    const std::array<CameraFrame, 3> frames{CameraFrame{axes.col(2), -axes.col(1)},
                                            CameraFrame{-axes.col(2), axes.col(1)},
                                            CameraFrame{axes.col(0), axes.col(2)}};
    const auto min_cosine = static_cast<float>(std::cos(radians(60.0)));
    for (const CameraFrame& frame : frames) {
        const Eigen::Vector3f view = frame.view.cast<float>();
        const bool sees_all =
            std::all_of(directions.begin(), directions.end(),
                        [&](const Eigen::Vector3f& ray) { return ray.dot(view) >= min_cosine; });
        if (sees_all && !directions.empty()) return {frame.up, true};
    }
    return {axes.col(2), false};
}

bool is_tilted(const UsualUp& source, const UsualUp& target, const Transform& target_from_source) {
    constexpr double max_tilt = radians(60.0);
    return target.up.dot(target_from_source.linear() * source.up) < std::cos(max_tilt);
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
    const double trust = are_cameras ? 1.0 : ups.size() > 1 ? 0.2 : 0.1;
    return trust * mean.normalized();
}

}  // namespace roomscribe
