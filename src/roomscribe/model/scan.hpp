// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// One cloud as the scanner left it, in the scanner's frame.
struct Scan {
    std::string name;  ///< file name, for people
    PointCloud cloud;

    /// Where the rays start, in the scan's frame: what the file says, else its origin.
    Eigen::Vector3d sensor_position() const {
        return cloud.sensor_pose ? Eigen::Vector3d(cloud.sensor_pose->translation())
                                 : Eigen::Vector3d::Zero();
    }
    /// The scanner's own frame -> the scan's.
    Eigen::Matrix3d sensor_axes() const {
        return cloud.sensor_pose ? Eigen::Matrix3d(cloud.sensor_pose->linear())
                                 : Eigen::Matrix3d::Identity();
    }
};

/// A run of points of the map that one scanner position saw.
struct MapSection {
    std::string name;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    /// Scanner position in the map frame, if known. Unknown for a cloud that was merged before.
    std::optional<Eigen::Vector3d> sensor_position;
    Eigen::Vector3d scan_shift = Eigen::Vector3d::Zero();  ///< global_shift of the scan itself
    /// The scanner's frame -> the map frame, where its position is known and its axes are, too.
    std::optional<Eigen::Matrix3d> sensor_axes = std::nullopt;
    /// No file says so: it is the scan's origin, where the scanner of most files stands.
    bool sensor_is_assumed = false;
};

/// A place from which clouds may have been seen that were merged before: nothing in them hides
/// these points of the map from there.
struct InferredView {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the map frame
    std::vector<std::uint32_t> points;
};

/// All scans in one frame, one after another in input order: every point of every scan, NaN too.
/// The points of a scan that could not be placed are NaN.
struct ScanMap {
    PointCloud cloud;
    std::vector<MapSection> sections;
    /// Instead of the scanners of sections that have none: see infer_views.
    std::vector<InferredView> inferred_views = {};
};

/// Puts the scans one after another. `map_from_scan[i]` is empty for a scan without a place.
/// Properties that only some scans have are dropped. Precondition: one pose slot per scan.
ScanMap merge_scans(std::span<const Scan> scans,
                    std::span<const std::optional<Transform>> map_from_scan);

/// The same, where the scans are not needed any more: each makes room as soon as it is in the map.
ScanMap merge_scans(std::vector<Scan>&& scans,
                    std::span<const std::optional<Transform>> map_from_scan);

/// A map of one cloud that stays as it is; where it was seen from is what its file says, else
/// unknown.
ScanMap map_of_cloud(Scan scan);

}  // namespace roomscribe
