// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"

namespace roomscribe {

struct RangeImageBorderSettings {
    int border_radius = 3;
    double min_border_score = 0.8;

    void visit(SettingVisitor& visitor) {
        visitor(border_radius,
                {.name = "border_radius",
                 .unit = "pixels",
                 .min = 1,
                 .max = 16,
                 .doc = "So far apart may an obstacle's border and its shadow's be."});
        visitor(min_border_score,
                {.name = "min_border_score",
                 .unit = "",
                 .min = 0.1,
                 .max = 1.0,
                 .doc = "A jump is a border from this score on; 0.8 is 5 times the distance of the "
                        "neighbours."});
    }
};

/// What a pixel is, as bits.
enum BorderTrait : std::uint8_t {
    obstacle_border = 1,  ///< the last pixel of something in front of something
    shadow_border = 2,    ///< the first pixel of what is behind
    veil_point = 4,       ///< between the two: the beam hit both
};

/// Borders and surface changes of a range image (Steder et al. 2011, sections III and IV), one
/// value per pixel.
struct RangeImageBorders {
    std::vector<std::uint8_t> traits;  ///< BorderTrait bits
    /// How much the surface changes, [0, 1]: 1 at an obstacle's border, else the spread of the
    /// normals around; 0 for pixels without a range, shadow borders and veil points.
    std::vector<float> surface_change_scores;
    /// Unit vector in the cloud's frame along which the surface changes most: at a border away from
    /// the obstacle, else of either sign; zero where the score is.
    std::vector<Eigen::Vector3f> surface_change_directions;

    /// Pixels that show no surface: the beam hit two, or grazed a border.
    bool is_background(std::size_t pixel) const {
        return (traits[pixel] & (shadow_border | veil_point)) != 0;
    }
};

/// Same result on any number of threads. The spread of normals below a score of 0.1 may be given
/// as 0: nobody looks at it.
RangeImageBorders find_range_image_borders(const RangeImage& image,
                                           const RangeImageBorderSettings& settings = {},
                                           const Context& context = {});

}  // namespace roomscribe
