// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_slides.hpp"

namespace roomscribe {
std::vector<Transform> slide_pose(const PointSpread& source, const Transform& target_from_source,
                                  std::span<const Eigen::Matrix<double, 6, 1>> twists,
                                  double distance) {
    constexpr double small = 1e-3;
    std::vector<Transform> poses;
    for (const Eigen::Matrix<double, 6, 1>& twist : twists) {
        const auto moved = [&](double length) {
            return transform_from_twist(length * twist) * target_from_source;
        };
        const double pace = rms_displacement(source, target_from_source, moved(small)) / small;
        if (!(pace > 0.0)) continue;
        for (const double steps : {-2.0, -1.0, 1.0, 2.0})
            poses.push_back(moved(steps * distance / pace));
    }
    return poses;
}

}  // namespace roomscribe
