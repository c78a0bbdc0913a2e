// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/saturated_returns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <Eigen/Core>

namespace roomscribe {

std::vector<std::uint32_t> find_saturated_returns(const Scan& scan) {
    // The last two shells of the range, each this share of it thick: 6 cm of 30 m.
    constexpr double shell_thickness = 0.002;
    // Fewer mislead nobody; in a place the shell before the last holds as many as the last.
    constexpr std::size_t min_returns = 100;
    constexpr std::size_t min_ratio = 20;
    // A plane crosses a shell of this thickness within 3.6 degrees of its perpendicular.
    constexpr double max_plane_spread = 7.0 / 180.0 * std::numbers::pi;

    const Eigen::Vector3d sensor = scan.sensor_position();
    const auto& positions = scan.cloud.positions;
    const auto ray_to = [&](std::size_t i) {
        return Eigen::Vector3d(positions[i].cast<double>() - sensor);
    };
    const std::vector<std::uint32_t> returns = finite_points(scan.cloud);
    double squared_end = 0.0;
    for (const std::uint32_t i : returns)
        squared_end = std::max(squared_end, ray_to(i).squaredNorm());
    const auto lies_within = [&](std::size_t i, double share_of_end) {
        return ray_to(i).squaredNorm() >= share_of_end * share_of_end * squared_end;
    };
    std::vector<std::uint32_t> last;
    std::size_t num_before_last = 0;
    for (const std::uint32_t i : returns) {
        if (!lies_within(i, 1.0 - 2.0 * shell_thickness)) continue;
        if (lies_within(i, 1.0 - shell_thickness)) {
            last.push_back(i);
        } else {
            ++num_before_last;
        }
    }
    // More than half: the inside of a dome.
    if (last.size() < std::max(min_returns, min_ratio * num_before_last) ||
        2 * last.size() > returns.size()) {
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

std::optional<Scan> without_saturated_returns(const Scan& scan) {
    const std::vector<std::uint32_t> saturated = find_saturated_returns(scan);
    if (saturated.empty()) return std::nullopt;
    Scan rest = scan;
    for (const std::uint32_t i : saturated)
        rest.cloud.positions[i].setConstant(std::numeric_limits<float>::quiet_NaN());
    return rest;
}

std::optional<ScanMap> without_saturated_returns(const ScanMap& map) {
    std::optional<ScanMap> cleaned;
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position) continue;
        Scan scan;
        const auto first = map.cloud.positions.begin() + section.first;
        scan.cloud.positions.assign(first, first + section.count);
        scan.cloud.sensor_pose = Transform(Eigen::Translation3d(*section.sensor_position));
        for (const std::uint32_t point : find_saturated_returns(scan)) {
            if (!cleaned) cleaned = map;
            cleaned->cloud.positions[section.first + point].setConstant(
                std::numeric_limits<float>::quiet_NaN());
        }
    }
    return cleaned;
}

}  // namespace roomscribe
