// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"
#include "roomscribe/registration/range_image/range_image_borders.hpp"

namespace roomscribe {

struct NarfKeypointSettings {
    double support_size = 0.5;
    double min_interest = 0.45;
    double min_distance = 0.25;
    double edge_distance = 0.25;
    double min_surface_change = 0.2;
    int max_keypoints = 0;
    RangeImageBorderSettings borders = {};

    void visit(SettingVisitor& visitor) {
        visitor(support_size, {.name = "support_size",
                               .unit = "m",
                               .min = 1e-3,
                               .max = 1e3,
                               .doc = "Diameter of the surface that a keypoint stands for."});
        visitor(min_interest, {.name = "min_interest",
                               .unit = "",
                               .min = 0.05,
                               .max = 1.0,
                               .doc = "Interest that a keypoint has at least."});
        visitor(min_distance, {.name = "min_distance",
                               .unit = "",
                               .min = 0.0,
                               .max = 10.0,
                               .doc = "Between keypoints, in support sizes."});
        visitor(edge_distance,
                {.name = "edge_distance",
                 .unit = "",
                 .min = 1e-3,
                 .max = 1.0,
                 .doc = "Keypoints nearer to a change of the surface lose interest: it makes their "
                        "normal unsteady. In halves of the support size."});
        visitor(min_surface_change, {.name = "min_surface_change",
                                     .unit = "",
                                     .min = 0.1,
                                     .max = 1.0,
                                     .doc = "Smaller changes of the surface count for nothing."});
        visitor(max_keypoints, {.name = "max_keypoints",
                                .unit = "",
                                .min = 0,
                                .max = 1e9,
                                .doc = "The best ones are kept; 0 keeps all."});
        visitor.group("borders", borders);
    }
};

struct NarfKeypoint {
    std::uint32_t pixel = 0;                             ///< of the range image
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< that pixel's point
    float interest = 0.0F;                               ///< [0, 1]
};

/// How well every pixel would do as a keypoint (Steder et al. 2011, section IV): there are changes
/// of the surface in two directions within half the support size, but none right here. 0 where it
/// cannot reach settings.min_interest.
std::vector<float> compute_narf_interest(const RangeImage& image, const RangeImageBorders& borders,
                                         const NarfKeypointSettings& settings = {},
                                         const Context& context = {});

/// Local maxima of the interest, best first, none nearer to a better one than the settings say.
/// The same on any number of threads. Empty if there are none.
std::vector<NarfKeypoint> detect_narf_keypoints(const RangeImage& image,
                                                const NarfKeypointSettings& settings = {},
                                                const Context& context = {});

}  // namespace roomscribe
