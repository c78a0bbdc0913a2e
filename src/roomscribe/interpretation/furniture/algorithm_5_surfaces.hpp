// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/geometry/sample_consensus.hpp"

namespace roomscribe {

struct FurnitureSurfaceSettings {
    double voxel_size = 0.035;
    double distance_tolerance = 0.02;
    int min_plane_inliers = 500;
    int min_plane_cluster = 500;
    double cluster_tolerance = 0.07;
    ConsensusSettings consensus;

    void visit(SettingVisitor& visitor) {
        visitor(voxel_size, {.name = "voxel_size",
                             .unit = "m",
                             .min = 1e-6,
                             .max = 1e6,
                             .doc = "Edge of the voxels to which the cloud is thinned (the paper's "
                                    "3.5 cm)."});
        visitor(distance_tolerance,
                {.name = "distance_tolerance",
                 .unit = "m",
                 .min = 1e-9,
                 .max = 1e3,
                 .doc = "How far a point of a plane may lie from it; the paper does not tell."});
        visitor(min_plane_inliers,
                {.name = "min_plane_inliers",
                 .unit = "",
                 .min = 3,
                 .max = 1e9,
                 .doc = "Fewest inliers of a plane, and fewest points to look for one in."});
        visitor(min_plane_cluster, {.name = "min_plane_cluster",
                                    .unit = "",
                                    .min = 1,
                                    .max = 1e9,
                                    .doc = "Fewest points of a surface (the paper's 500)."});
        visitor(cluster_tolerance, {.name = "cluster_tolerance",
                                    .unit = "m",
                                    .min = 1e-9,
                                    .max = 1e3,
                                    .doc = "Points no further apart are one cluster: two voxels."});
        visitor.group("consensus", consensus);
    }
};

/// A cluster of points on a plane that lies along two of the axes.
struct FurnitureSurface {
    Plane plane;   ///< least squares; the normal within a right angle of its axis
    int axis = 0;  ///< number of the axis that the plane is perpendicular to
    std::vector<std::uint32_t> points;  ///< numbers in FurnitureSurfaces::cloud, ascending
};

struct FurnitureSurfaces {
    PointCloud cloud;                           ///< the input, thinned
    std::vector<std::uint32_t> voxel_of_point;  ///< per input point, or no_voxel
    std::vector<FurnitureSurface> surfaces;     ///< in the order in which they were found
};

/// The first half of the paper's Algorithm 5 (Appendix A; its section 4.4), as it is written: for
/// each axis of the room in turn, while enough points are left, the plane perpendicular to it with
/// the most inliers is taken out of the cloud, and its clusters that are large enough are surfaces.
/// Those perpendicular to the vertical axis are tables and other level surfaces, the others faces
/// of furniture.
///
/// `cloud` is what floor, ceiling and walls have left. `axes` has unit row vectors, up last. What
/// the pseudo-code leaves open: a plane is drawn through one point, perpendicular to the axis, and
/// fitted to its inliers afterwards; an axis is done when its best plane has too few inliers.
FurnitureSurfaces detect_furniture_surfaces(const PointCloud& cloud, const Eigen::Matrix3d& axes,
                                            std::uint64_t seed,
                                            const FurnitureSurfaceSettings& settings = {},
                                            const Context& context = {});

}  // namespace roomscribe
