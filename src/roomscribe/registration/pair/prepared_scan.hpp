// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/preprocessing/scanner_up.hpp"
#include "roomscribe/registration/features/described_points.hpp"
#include "roomscribe/registration/pair/free_space.hpp"
#include "roomscribe/registration/pair/scan_features.hpp"
#include "roomscribe/registration/pair/surface_directions.hpp"
#include "roomscribe/registration/pair/surface_grid.hpp"

namespace roomscribe {

/// Two normals at least this near to each other may be of one surface, each estimated from another
/// scan's points: 45 degrees.
inline constexpr double same_surface_cosine = 0.707;

/// A scan thinned to one spacing, with normals towards the scanner.
struct SurfacePoints {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;
    std::vector<float> deviations;  ///< m, of a point's neighbours about their plane
    SearchTree tree;
};

struct OrientedPoints {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;
    std::vector<float> deviations;
};

/// Points of a scan that a pose is held against, and the pieces of surface they belong to: cubes of
/// 0.3 m or three coarse voxels. Points of one piece are no independent witnesses.
struct WitnessSet {
    OrientedPoints points;
    std::vector<std::uint32_t> pieces;  ///< of every point: index into cubes
    std::vector<Eigen::Vector3i>
        cubes;               ///< of every piece, counted in cubes from the scan's origin
    double cube_size = 0.3;  ///< m
};

struct Witnesses {
    WitnessSet shell;   ///< on one of the scan's large planes
    WitnessSet detail;  ///< all others: furniture, reveals, what is small
};

/// Sizes that follow from the scans. Those marked are shared by all scans of a job, so that their
/// descriptors can be compared.
struct RegistrationScale {
    double coarse_voxel = 0.1;  ///< m, of the points that are matched; shared
    double fine_voxel = 0.05;   ///< m, of the points that are aligned
    double fpfh_radius = 0.5;   ///< m; shared
    double narf_support = 0.5;  ///< m; shared
    double noise = 0.01;        ///< m
};

/// All that registration needs of a scan, computed once however many partners it meets.
struct PreparedScan {
    RegistrationScale scale;
    SurfacePoints coarse;
    SurfacePoints fine;
    OrientedPoints coarse_sample;  ///< some of the coarse points, spread evenly
    OrientedPoints fine_sample;    ///< some of the fine points, spread evenly
    Witnesses witnesses;           ///< some of the fine points, spread evenly
    DescribedPoints fpfh;          ///< some of the coarse points
    DescribedPoints narf;          ///< empty unless the features want them
    PointSpread spread;            ///< of the coarse points
    FreeSpace free_space;
    /// The rays really start at the sensor position: what they passed through may be used.
    bool free_space_is_valid = false;
    SurfaceGrid coarse_grid;                   ///< over the coarse points
    std::vector<SurfaceDirection> directions;  ///< of the coarse points
    UsualUp usual_up;                          ///< in the scan's frame
};

/// Whether both are frames of cameras: all they see lies in a cone about the way they look.
bool are_cameras(const PreparedScan& a, const PreparedScan& b);

/// The noise and the spacing of the worse of two scans.
RegistrationScale joint_scale(const PreparedScan& a, const PreparedScan& b);

/// Voxel grid, outlier removal, normals, keypoints, descriptors (steps 1 and 2 of the paper's
/// Algorithm 1). FPFH is always there, since it also says which scans may show the same place: at
/// NARF keypoints for `fpfh_at_narf`, else at the most distinctive points.
PreparedScan prepare_scan(const Scan& scan, const RegistrationScale& scale,
                          PairFeatures features = PairFeatures::fpfh, const Context& context = {});

}  // namespace roomscribe
