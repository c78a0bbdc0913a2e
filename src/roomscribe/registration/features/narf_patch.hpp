// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include "roomscribe/registration/range_image/range_image.hpp"

namespace roomscribe {

/// A square of surface seen along its normal: depth behind the tangent plane, m, in cells row by
/// row from above.
inline constexpr std::size_t narf_patch_side = 20;
using NarfPatch = std::array<float, narf_patch_side * narf_patch_side>;

/// Takes points of the cloud to the frame of a keypoint's patch: x right, y down, z away from the
/// scanner, along the surface's normal. Empty if there is not enough surface.
std::optional<Eigen::Isometry3f> narf_frame(const RangeImage& image, std::size_t pixel,
                                            float support_size);

/// The surface around the origin of a frame, smoothed. Where nothing was seen it is as deep as the
/// patch is wide to each side.
NarfPatch narf_patch(const RangeImage& image, std::size_t pixel, const Eigen::Isometry3f& frame,
                     float support_size);

}  // namespace roomscribe
