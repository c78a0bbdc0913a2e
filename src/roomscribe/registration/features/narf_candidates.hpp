// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/registration/features/narf_changes.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"
#include "roomscribe/registration/range_image/range_image_borders.hpp"

namespace roomscribe {

/// Lengths in metres.
struct NarfReach {
    float radius = 0.0F;         ///< changes within it make a keypoint
    float edge_distance = 0.0F;  ///< changes within it spoil one
    float min_interest = 0.0F;
};

/// What a change at some nearness to a pixel leaves of its interest.
constexpr float narf_steadiness(float edge) {
    return (1.0F - 0.5F * edge) * (1.0F - 0.5F * edge);
}

/// Of all pixels whose interest could be enough if the surface were connected everywhere, the
/// steadiness that the changes right beside leave at most; else 0. Squares of pixels are held
/// against an upper bound of their interest, and divided only if it is enough.
std::vector<float> find_narf_candidates(const RangeImage& image, const RangeImageBorders& borders,
                                        const NarfChanges& changes, const NarfReach& reach,
                                        const Context& context);

}  // namespace roomscribe
