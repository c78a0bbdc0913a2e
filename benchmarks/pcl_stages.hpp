// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/features/fpfh_descriptor.hpp"

namespace roomscribe::benchmark {

/// PCL's data of one scan, so that timing a stage does not time a conversion.
struct PclScan {
    PclScan();
    ~PclScan();
    struct Data;
    std::unique_ptr<Data> data;
};

/// PCL's stages, each on what `set_...` or an earlier stage left in the scan. Two threads where PCL
/// has threads.
struct PclStages {
    static void read(PclScan& scan, const std::filesystem::path& path);
    static void set_points(PclScan& scan, std::span<const Eigen::Vector3f> positions,
                           std::span<const Eigen::Vector3f> normals);
    static void set_descriptors(PclScan& scan, const FpfhDescriptors& descriptors);

    static void downsample(PclScan& scan, double voxel_size);  ///< raw points -> points
    static void estimate_normals(PclScan& scan, int num_neighbors);
    static void describe(PclScan& scan, double radius);
    /// Range image of the raw points, borders, keypoints and descriptors; returns how many
    /// keypoints.
    static std::size_t find_narf(const PclScan& scan, double angular_resolution,
                                 double support_size);
    /// Mutual nearest neighbours; returns how many.
    static std::size_t match(PclScan& source, const PclScan& target);
    static Transform reject(const PclScan& source, const PclScan& target, double inlier_distance);
    static Transform align(const PclScan& source, const PclScan& target, const Transform& guess,
                           double max_distance);
    /// The loop of the paper over the raw points: returns how many planes.
    static std::size_t detect_planes(const PclScan& scan, double tolerance, int min_inliers);
};

}  // namespace roomscribe::benchmark
