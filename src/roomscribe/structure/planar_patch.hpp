// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

/// A connected piece of planar surface. Coplanar pieces that do not touch are separate patches.
struct PlanarPatch {
    /// Least-squares plane of the points. Its normal looks where most of the points' own normals
    /// look: to the scanner, where those do.
    Plane plane;
    std::vector<std::uint32_t> points;  ///< numbers in the cloud it was found in, ascending
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    double rms = 0.0;                 ///< m, of the points about the plane
    double area = 0.0;                ///< m2, see occupied_area
    bool may_face_both_ways = false;  ///< see face_inferred_views
};

/// Area of the surface that points on a plane stand for: the squares of edge `cell_size` on the
/// plane that hold a point. Points further apart than `cell_size` count a square each.
double occupied_area(std::span<const Eigen::Vector3f> positions,
                     std::span<const std::uint32_t> points, const Plane& plane, double cell_size);

/// A patch of points near a plane, whether or not they are connected: the plane is fitted to them,
/// and where the cloud has normals these decide its sign. `inliers` number the cloud's points.
PlanarPatch make_planar_patch(const PointCloud& cloud, Plane plane,
                              std::vector<std::uint32_t> inliers);

}  // namespace roomscribe
