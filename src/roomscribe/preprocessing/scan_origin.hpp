// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

/// Whether a cloud that does not say where it was seen from was seen from its own origin, as
/// scanners write their scans: then points that lie side by side as seen from there lie at one
/// distance, but for the edges of things. In a map of several scans, or one that was moved, what is
/// behind shows through what is before.
///
/// `share_of_jumps`: of neighbours in direction, those at different distances. False for fewer than
/// 1000 finite points, which tell nothing.
struct OriginTest {
    bool is_scanner = false;
    double share_of_jumps = 1.0;
};
OriginTest test_scan_origin(const PointCloud& cloud);

}  // namespace roomscribe
