// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/context.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/model/scene.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// Gives unlabelled points of walls and ceilings that are not plane to them: fused depth images and
/// tilting lasers bend them by several centimetres, and their planes hold no more than a part.
/// Floors do not go on so: what stands on them begins there.
///
/// A wall goes on from voxel to voxel of the sample while these have no label, turn from its plane
/// by less than 20 degrees, and lie no more than a slight slope and the noise deeper or higher than
/// the last: pictures, boards and fronts are a step away. It ends three tolerances from its plane.
/// The confidence of such points is half of the wall's. Precondition: labels of the points
/// that the sample was made of.
void continue_bent_walls(const SurfaceSample& sample, const RoomSurfaces& surfaces,
                         PointLabels& labels, const Context& context = {});

}  // namespace roomscribe
