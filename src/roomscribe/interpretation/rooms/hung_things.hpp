// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/interpretation/rooms/wall_faces.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// Marks in `is_hung`, per voxel of the sample, what hangs flat on walls and is no part of them:
/// pictures, boards, screens. Such a thing is a patch of its own that fills most of a rectangle of
/// at most a whiteboard's size, stands a step out of the wall, and has the wall around it on all
/// four sides: fronts and casings stand on the floor, and where a wall bends it goes on at one side
/// at least. Steps are measured against the wall just beside it. Precondition: `is_hung` has an
/// entry per voxel.
void mark_hung_things(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                      std::span<const WallFace> faces, const Eigen::Vector3d& up,
                      std::vector<bool>& is_hung);

}  // namespace roomscribe
