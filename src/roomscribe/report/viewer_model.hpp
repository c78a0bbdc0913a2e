// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "roomscribe/pipeline/reconstruct.hpp"
#include "roomscribe/report/viewer_points.hpp"

namespace roomscribe {

/// Components that are not rejected, in their order: what scene.json lists.
std::vector<std::size_t> listed_components(const Scene& scene);

/// The room that a component belongs to by its parents, however many.
std::optional<std::size_t> room_by_parents(const Scene& scene, const Component& component);

/// What the 3D view shows beside points, as JSON in the room frame (docs/viewer.md): labels,
/// components with their evidence and as convex pieces without their openings, rooms, scanners.
/// `num_shown` points are in the report.
std::string viewer_model_json(const Reconstruction& reconstruction, const GriddedPoints& points,
                              std::size_t num_shown);

}  // namespace roomscribe
