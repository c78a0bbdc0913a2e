// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/model/surface_truth.hpp"

namespace roomscribe {

/// How well one true surface was found.
struct SurfaceMatch {
    std::uint32_t surface = 0;
    std::uint64_t points = 0;  ///< that lie on it
    /// Planes most of whose points lie on it, the one with most of its points first. Several where
    /// furniture cuts it in pieces; none if it was missed.
    std::vector<std::uint32_t> planes;
    double recall = 0.0;        ///< share of its points that these planes hold
    double precision = 0.0;     ///< share of their points that lie on it, of those on any surface
    double normal_error = 0.0;  ///< rad, of the first plane
    double offset_error = 0.0;  ///< m, between the planes at the middle of the first one's points
};

struct PlaneError {
    std::vector<SurfaceMatch> surfaces;       ///< those that are large enough to count
    std::vector<std::uint32_t> false_planes;  ///< large ones of which no surface holds half
    std::uint64_t num_missed = 0;
};

/// From what on a surface counts as a miss, and a plane as a false one.
struct PlaneErrorLimits {
    std::uint64_t min_points = 500;
    double min_area = 0.1;  ///< m2
};

/// A plane that was found and its area, m2.
struct FoundPlane {
    Plane plane;
    double area = 0.0;
};

/// Holds planes against the surfaces that are there. `plane_of_point`: per point of the map the
/// plane it was given to, or -1. Points that lie on no surface are left out.
PlaneError evaluate_planes(const SurfaceTruth& truth, std::span<const Eigen::Vector3f> positions,
                           std::span<const FoundPlane> planes,
                           std::span<const std::int32_t> plane_of_point,
                           const PlaneErrorLimits& limits = {});

}  // namespace roomscribe
