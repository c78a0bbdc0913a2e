// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Whether a cloud that does not say where it was seen from was seen from its own origin, as
/// scanners write their scans: then points that lie side by side as seen from there lie at one
/// distance, but for the edges of things. In a map of several scans, or one that was moved, what is
/// behind shows through what is before.
///
/// `share_of_jumps`: of neighbours in direction, those at different distances. False, and a share
/// of 1, for fewer than 1000 finite points, which tell nothing.
struct OriginTest {
    bool is_scanner = false;
    double share_of_jumps = 1.0;
};
OriginTest test_scan_origin(const PointCloud& cloud);

/// Tests the scanners that a map assumes, and takes away those that were none for certain: the scan
/// was a map itself. To a map of a single cloud that has none it gives the cloud's origin if that
/// stands test_scan_origin (and the cloud is not shifted: far coordinates begin nowhere). Returns
/// the tests, by section, of those that tell something.
std::vector<std::pair<std::size_t, OriginTest>> settle_assumed_scanners(ScanMap& map,
                                                                        const Context& context);

}  // namespace roomscribe
