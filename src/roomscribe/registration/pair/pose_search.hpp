// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// True if the directions of at least a twentieth of the surface each span space.
bool faces_three_ways(std::span<const SurfaceDirection> directions);

/// Poses under which the flat surfaces of two scans fall together, without any match of points.
/// Surfaces of buildings share few directions, so the rotations that take directions of one scan to
/// directions of the other can be listed (24 where all is at right angles); along each direction
/// the surfaces of a scan lie at few distances, and the shifts that bring distances of one scan to
/// those of the other can be listed too. What is listed is complete where both scans face three
/// ways in common: the right pose is among it, and so are those that a rectangular
/// room or a repeated office mistakes for it. Empty where a scan shows fewer than two directions.
/// Invariant to rigid motion of either scan up to rounding; no random draw.
std::vector<Transform> search_poses(const PreparedScan& source, const PreparedScan& target,
                                    const RegistrationScale& scale, const Context& context = {});

}  // namespace roomscribe
