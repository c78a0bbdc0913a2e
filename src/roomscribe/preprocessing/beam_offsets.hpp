// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/model/scan.hpp"
#include "roomscribe/preprocessing/false_returns.hpp"

namespace roomscribe {

// A spinning lidar draws each of its rings with a laser of its own, and each laser has a range
// error of its own, up to some centimetres (Glennie and Lichti 2010, Static calibration and
// analysis of the Velodyne HDL-64E S2): as much as the noise of a single range, but no averaging
// along the ring lessens it. Flat surfaces that several rings cross tell it.

/// What a scanner saw, and from where.
struct ScannedPoints {
    std::span<const Eigen::Vector3f> positions;
    Eigen::Vector3d sensor_position = Eigen::Vector3d::Zero();
    Eigen::Matrix3d sensor_axes = Eigen::Matrix3d::Identity();  ///< scanner's frame -> the points'
};

/// The beams of a scan, each a ring of one elevation, by rising elevation.
struct BeamOffsets {
    std::vector<std::int32_t> beam_of_point;  ///< -1 for what is on no ring
    std::vector<double> elevation_sines;      ///< per beam, to a thousandth
    std::vector<double> offsets;              ///< m, per beam: its ranges are too long by so much
};

/// Empty where the points do not lie on 8 to 128 rings about the z axis of the scanner, and where
/// two halves of what they saw do not tell like offsets of at least 5 mm: where little is flat, or
/// nothing wrong. What all beams have in common, or what changes evenly from each to the next, no
/// surface tells; it is taken for none.
std::optional<BeamOffsets> find_beam_offsets(const ScannedPoints& scan);

/// The same of the scans of one job, which mostly are of one scanner: a scan that does not tell
/// offsets itself has the mean ones of those with like rings, if two or more tell them.
std::vector<std::optional<BeamOffsets>> find_beam_offsets(std::span<const ScannedPoints> scans);

/// Takes the beams' offsets out of the ranges, in place.
void remove_beam_offsets(std::span<Eigen::Vector3f> positions,
                         const Eigen::Vector3d& sensor_position, const BeamOffsets& beams);

/// Both for each scanner of a map whose place and axes are known. Returns what to put back.
std::vector<HiddenPoint> remove_beam_offsets(ScanMap& map);

}  // namespace roomscribe
