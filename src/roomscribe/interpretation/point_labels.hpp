// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/interpretation/openings/wall_openings.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/model/scene.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

struct PointLabelSettings {
    std::optional<double> distance_tolerance;

    void visit(SettingVisitor& visitor) {
        visitor(
            distance_tolerance,
            {.name = "distance_tolerance",
             .unit = "m",
             .min = 1e-9,
             .max = 1e3,
             .doc = "A point of a surface lies no further from its plane; auto: the tolerance of "
                    "the planes, or 2.5 x the surface's own rms where that is more."});
    }
};

/// A label, an instance and a confidence for every point of the map, in its order. A point belongs
/// to the surface to whose plane it is nearest among those that it is near enough to and within
/// whose polygon, widened by the spacing of the sample, it lies; where the surface bends, nearness
/// to one of its patches counts as well. What lies in the hole of a door or window, or in its
/// frame, is theirs before it is the wall's; so is the leaf of a door that stands open. The
/// confidence is the surface's, less the further the point is from it. All other points, and those
/// that are not finite, are unknown: label unknown, instance -1, confidence 0. What stands in the
/// rooms is labelled by label_furniture afterwards.
PointLabels label_points(const PointCloud& map, const SurfaceSample& sample,
                         std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                         const Openings& openings, const PointLabelSettings& settings = {},
                         const Context& context = {});

}  // namespace roomscribe
