// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/saturated_returns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <Eigen/Core>

namespace roomscribe {

namespace {

std::vector<std::uint32_t> find_saturated(std::span<const Eigen::Vector3f> positions,
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

}  // namespace

std::vector<std::uint32_t> find_saturated_returns(const Scan& scan) {
    return find_saturated(scan.cloud.positions, scan.sensor_position());
}

std::optional<Scan> without_saturated_returns(const Scan& scan) {
    const std::vector<std::uint32_t> saturated = find_saturated_returns(scan);
    if (saturated.empty()) return std::nullopt;
    Scan rest;
    rest.name = scan.name;
    rest.cloud.positions = scan.cloud.positions;
    rest.cloud.normals = scan.cloud.normals;
    rest.cloud.grid = scan.cloud.grid;
    rest.cloud.sensor_pose = scan.cloud.sensor_pose;
    rest.cloud.global_shift = scan.cloud.global_shift;
    for (const std::uint32_t i : saturated)
        rest.cloud.positions[i].setConstant(std::numeric_limits<float>::quiet_NaN());
    return rest;
}

std::vector<HiddenPoint> hide_saturated_returns(ScanMap& map) {
    std::vector<HiddenPoint> hidden;
    std::vector<Eigen::Vector3f>& positions = map.cloud.positions;
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position) continue;
        const auto of_section = std::span(positions).subspan(section.first, section.count);
        for (const std::uint32_t i : find_saturated(of_section, *section.sensor_position)) {
            const std::uint32_t number = section.first + i;
            hidden.push_back({number, positions[number]});
            positions[number].setConstant(std::numeric_limits<float>::quiet_NaN());
        }
    }
    return hidden;
}

void put_back(std::span<const HiddenPoint> hidden, ScanMap& map) {
    for (const HiddenPoint& point : hidden)
        map.cloud.positions[point.number] = point.position;
}

}  // namespace roomscribe
