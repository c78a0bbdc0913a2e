// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/structure/neighbor_graph.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

struct PlaneGrowingSettings {
    double distance_tolerance = 0.03;
    double normal_tolerance = radians(22.5);
    int num_neighbors = 12;
    int min_points = 30;
    double min_area = 0.05;
    double cell_size = 0.08;

    void visit(SettingVisitor& visitor) {
        visitor(distance_tolerance, {.name = "distance_tolerance",
                                     .unit = "m",
                                     .min = 1e-9,
                                     .max = 1e6,
                                     .doc = "A point belongs to a plane no further from it."});
        visitor(
            normal_tolerance,
            {.name = "normal_tolerance",
             .unit = "rad",
             .min = 0.0,
             .max = 1.5707963267948966,
             .doc = "Largest angle between a point's normal and its plane's. Half of 45 degrees, "
                    "the least angle at which surfaces of a building commonly meet."});
        visitor(num_neighbors, {.name = "num_neighbors",
                                .unit = "",
                                .min = 3,
                                .max = 1000,
                                .doc = "Nearest points to which a patch may grow from a point."});
        visitor(min_points, {.name = "min_points",
                             .unit = "",
                             .min = 3,
                             .max = 1e9,
                             .doc = "Fewest points of a patch."});
        visitor(min_area, {.name = "min_area",
                           .unit = "m2",
                           .min = 0.0,
                           .max = 1e9,
                           .doc = "Smallest area of a patch; that of a cabinet's drawer front by "
                                  "default."});
        visitor(cell_size, {.name = "cell_size",
                            .unit = "m",
                            .min = 1e-6,
                            .max = 1e6,
                            .doc = "Edge of the squares by which a patch's area is counted: about "
                                   "twice the distance of neighbouring points."});
    }
};

/// All planar patches of an evenly sampled cloud, the largest area first. Region growing over
/// planar seeds (Rabbani et al. 2006, Vo et al. 2015): from the flattest neighbourhood that is
/// still free, a plane spreads over neighbouring points that lie on it with normals like its own,
/// is refitted by least squares whenever the patch has doubled, and spreads anew from the final
/// fit. Then pieces of one surface that touch are merged, and points at the rim, whose own normals
/// say nothing, join the plane they lie on. There is no random draw in it.
///
/// The cloud's order does not matter but for ties. Empty if nothing is planar; points of no patch
/// are nobody's. Throws InvalidArgument if the cloud has no normals or points that are not finite.
std::vector<PlanarPatch> grow_planar_patches(const PointCloud& cloud,
                                             const PlaneGrowingSettings& settings = {},
                                             const Context& context = {});

/// The same over a graph that is at hand: that of the cloud's positions.
std::vector<PlanarPatch> grow_planar_patches(const PointCloud& cloud, const NeighborGraph& graph,
                                             const PlaneGrowingSettings& settings = {},
                                             const Context& context = {});

}  // namespace roomscribe
