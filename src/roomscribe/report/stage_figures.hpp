// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "roomscribe/core/context.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe {

/// What the model was made of, as in the paper's Fig. 3: planes, boundaries, lines and
/// quadrilaterals, seen from above at a slant, without what turns its back on the viewer. Empty
/// where the reconstruction has no patches.
std::string stage_figures(const Reconstruction& reconstruction, const Context& context);

}  // namespace roomscribe
