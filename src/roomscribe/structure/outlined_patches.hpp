// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/surface_outlines.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// The stages of the paper's section 4.3 on patches of the sample, to be looked at: boundary
/// points, lines, rectangles. One for each patch that is as large as a sheet of paper, in their
/// order; lines are as exact as the sample is dense. Interpretation does not need them.
std::vector<OutlinedPatch> outline_patches(const SurfaceSample& sample,
                                           std::span<const PlanarPatch> patches,
                                           const Context& context = {});

}  // namespace roomscribe
