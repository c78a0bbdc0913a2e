// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/simulation/scanning/ray_caster.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// A scan and what each of its points is. The grid is kept: a ray without return is NaN, unknown,
/// instance -1.
struct SimulatedScan {
    Scan scan;
    Transform world_from_scan = Transform::Identity();
    std::vector<Label> labels;
    std::vector<std::int32_t> instances;
    std::vector<LabelSet> acceptable;
};

/// What a scanner at the station records, in its own frame, with its noise and losses. The same
/// seed gives the same bits on any number of threads.
SimulatedScan scan_world(const RayCaster& caster, ScannerKind scanner, double coarseness,
                         const Station& station, std::uint64_t seed, const Context& context = {});

/// Where the scanner is and how it is turned.
Transform scanner_pose(ScannerKind scanner, const Station& station);

/// True if the scanner has rays in this direction (of its own frame) and at this range.
bool is_in_view(ScannerKind scanner, const Eigen::Vector3d& point_in_scan);

}  // namespace roomscribe
