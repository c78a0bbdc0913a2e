// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"

namespace roomscribe {

struct NarfSettings {
    double support_size = 0.5;
    bool rotation_invariant = true;

    void visit(SettingVisitor& visitor) {
        visitor(support_size, {.name = "support_size",
                               .unit = "m",
                               .min = 1e-3,
                               .max = 1e3,
                               .doc = "Side of the square of surface that is described."});
        visitor(rotation_invariant,
                {.name = "rotation_invariant",
                 .unit = "",
                 .doc = "Turn each patch into its own dominant orientations, instead of upright."});
    }
};

inline constexpr int narf_size = 36;

/// One column per descriptor; compare columns by the Manhattan metric.
struct NarfDescriptors {
    /// Each value, in [-0.5, 0.5], says how the surface falls off along one of 36 beams, 10 degrees
    /// apart, that leave the keypoint within its tangent plane.
    Eigen::Matrix<float, narf_size, Eigen::Dynamic> values;
    std::vector<std::uint32_t> keypoints;  ///< which of the given pixels a column describes
    /// Where the first beam of a column points, rad, clockwise from the scanner's "up" as the
    /// scanner sees it; 0 unless rotation invariant.
    std::vector<float> orientations;
};

/// Normal Aligned Radial Features (Steder et al. 2011, section V): a patch of the surface seen
/// along its normal, and how it changes along a star of beams. With rotation_invariant a keypoint
/// has a column for each of its dominant orientations, at least 70 degrees apart (none if no
/// direction differs from another), the strongest first; else one, upright, which is undefined for
/// level surfaces. Pixels without enough surface around them have no column. Columns keep the order
/// of the pixels. The same on any number of threads.
/// Precondition: every pixel < image.size().
NarfDescriptors compute_narf(const RangeImage& image, std::span<const std::uint32_t> pixels,
                             const NarfSettings& settings = {}, const Context& context = {});

}  // namespace roomscribe
