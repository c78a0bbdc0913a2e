// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_changes.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

std::uint8_t angle_cell(const RangeImage& image, std::size_t pixel,
                        const Eigen::Vector3f& direction) {
    const Eigen::Vector3f ray = image.points[pixel] - image.sensor_position;
    const Eigen::Vector3f right = image.up.cross(ray);
    const Eigen::Vector3f above = ray.cross(right);
    const float x = direction.dot(right) * ray.norm();
    const float y = direction.dot(above);
    constexpr float pi = std::numbers::pi_v<float>;
    const float angle = std::atan2(y, x) + (y < 0.0F ? pi : 0.0F);  // [0, pi]
    const auto cell = static_cast<int>(angle / pi * static_cast<float>(num_change_angles));
    return static_cast<std::uint8_t>(cell % static_cast<int>(num_change_angles));
}

}  // namespace

NarfChanges find_narf_changes(const RangeImage& image, const RangeImageBorders& borders,
                              float min_change, const Context& context) {
    NarfChanges changes{
        std::vector<std::uint8_t>(image.size(), NarfChanges::no_angle),
        std::vector<std::uint8_t>(image.size(), 0),
    };
    parallel_for(context, image.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!image.has_range(i) || borders.is_background(i)) continue;
            changes.is_surface[i] = 1;
            if (borders.surface_change_scores[i] < min_change) continue;
            changes.angles[i] = angle_cell(image, i, borders.surface_change_directions[i]);
        }
    });
    return changes;
}

}  // namespace roomscribe
