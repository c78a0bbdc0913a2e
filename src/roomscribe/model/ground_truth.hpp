// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/label.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// What is known of scans whose world was made: what a result is held against.
struct GroundTruth {
    /// All scans by their true poses, one after another, in a world frame of any orientation.
    ScanMap map;
    std::vector<Transform> map_from_scan;
    /// Components carry `visible`. What has none of the ten labels (pictures, radiators, columns,
    /// ...) is a component with Label::unknown and a `kind`. In the map's frame.
    Scene scene;
    std::vector<Label> labels;            ///< per point of the map
    std::vector<std::int32_t> instances;  ///< Component::instance, -1 where none
    /// Per point, the labels that are right (docs/formats.md): a column may be wall or unknown, a
    /// mixed pixel may have either neighbour's label. Always includes the point's own label.
    std::vector<LabelSet> acceptable;
};

}  // namespace roomscribe
