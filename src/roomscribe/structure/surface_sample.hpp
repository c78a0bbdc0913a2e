// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"
#include "roomscribe/structure/planar_patch.hpp"

namespace roomscribe {

/// The map thinned to an even sample of its surfaces: what planes are looked for in, so that the
/// density near a scanner does not decide.
struct SurfaceSample {
    PointCloud cloud;  ///< centroid and unit normal (NaN where there is none) per voxel
    std::vector<std::uint32_t> voxel_of_point;  ///< per map point: its voxel, or no_voxel
    /// Every normal looks to a scanner that saw the point, or to a place that it may have been seen
    /// from. False where neither is known of a section: then the normals' signs mean nothing.
    bool normals_face_scanner = false;
    std::vector<Eigen::Vector3d> sensor_positions;  ///< the known ones
    /// Which way is up if the scanners are mounted as most are: see common_up.
    Eigen::Vector3d usual_up = Eigen::Vector3d::Zero();
    double voxel_size = 0.0;  ///< m
    /// m, distance of neighbouring points of the sample where the surface is sampled as most of it.
    double spacing = 0.0;
    /// m, standard deviation of the points about smooth surface: that of the statistics, or the
    /// lower quartile over the sample where that is more.
    double noise = 0.0;
    /// m, per voxel: the standard deviation of its points across its surface, as they follow from
    /// its range and the angle at which it was seen; `noise` at least. A depth camera sees what is
    /// far with ten times the noise of what is near.
    std::vector<float> noise_of_voxel;
    /// m, how far a point of a plane may lie from it: see plane_tolerance.
    double tolerance = 0.0;
};

struct SurfaceSampleSettings {
    std::optional<double> voxel_size;
    int num_neighbors = 16;

    void visit(SettingVisitor& visitor) {
        visitor(voxel_size, {.name = "voxel_size",
                             .unit = "m",
                             .min = 1e-6,
                             .max = 1e6,
                             .doc = "Edge of a voxel of the surface sample; auto: half the point "
                                    "spacing, at least 0.04 m."});
        visitor(
            num_neighbors,
            {.name = "num_neighbors",
             .unit = "",
             .min = 3,
             .max = 1000,
             .doc = "Nearest voxels, the voxel itself among them, that a normal is fitted to."});
    }
};

/// Edge of the voxels for a surface with these statistics: half the point spacing, so that only
/// what is denser than most of the surface is thinned, but not under 0.04 m, the width of the
/// narrowest planar thing that a room model shows (a door frame's face).
double surface_voxel_size(const ScanStatistics& statistics);

/// How far a point of a planar surface may lie from its plane: 3 standard deviations of noise and
/// the unevenness that building practice allows finished walls (DIN 18202: 10 mm over 4 m), as
/// independent errors.
double plane_tolerance(double noise);

/// Voxel grid, normals, and their signs by vote of the scanners that saw each voxel. Empty for a
/// map without finite points.
SurfaceSample sample_surface(const ScanMap& map, const ScanStatistics& statistics,
                             const SurfaceSampleSettings& settings = {},
                             const Context& context = {});

/// Turns normals and patches to the inferred views of a map none of whose scanners is known.
/// Whether it has any.
bool face_inferred_views(const ScanMap& map, SurfaceSample& sample, std::span<PlanarPatch> patches);

}  // namespace roomscribe
