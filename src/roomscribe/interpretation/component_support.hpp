// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// Fills what labelled points say of the components in `evidence`: `points` that carry its instance
/// (those of its faces and handles too, for a piece of furniture), the number of `scans` that they
/// are from, and, where no rule measured it, the `rms` of a flat thing: the residual of its points
/// to a plane through them. Flat are leaves of doors and faces of furniture, wherever they stand;
/// a frame goes round a wall's edge, and what returns from a pane lies before and behind it.
///
/// Precondition: one label per point of the map.
void measure_support(const ScanMap& map, const PointLabels& labels, std::span<Component> components,
                     const Context& context = {});

}  // namespace roomscribe
