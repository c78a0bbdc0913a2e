// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"
#include "roomscribe/registration/range_image/range_image_borders.hpp"

namespace roomscribe {

constexpr std::size_t num_change_angles = 18;

/// Strongest change of the surface per direction.
using AngleHistogram = std::array<float, num_change_angles>;

/// What two directions of change count together: 0 if they are the same, 1 at right angles.
constexpr float angle_difference(std::size_t a, std::size_t b) {
    const std::size_t steps = a > b ? a - b : b - a;
    const float difference = 2.0F * static_cast<float>(steps) / num_change_angles;
    return difference < 1.0F ? difference : 2.0F - difference;
}

/// The changes of an image's surface that count for keypoints, one value per pixel.
struct NarfChanges {
    static constexpr std::uint8_t no_angle = 255;

    /// Direction of the change as the scanner sees it, in steps of 10 degrees; a direction and its
    /// opposite are the same. `no_angle` where the surface hardly changes.
    std::vector<std::uint8_t> angles;
    std::vector<std::uint8_t> is_surface;  ///< has a range that is neither shadow nor veil

    bool has_change(std::size_t pixel) const { return angles[pixel] != no_angle; }
};

NarfChanges find_narf_changes(const RangeImage& image, const RangeImageBorders& borders,
                              float min_change, const Context& context);

}  // namespace roomscribe
