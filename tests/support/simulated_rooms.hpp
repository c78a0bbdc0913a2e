// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/label.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe::test {

/// A room of L shape with a table, a wardrobe, a shelf, a bed and smaller things: alike to itself
/// under no motion. Its floor is z = 0; it lies in [0, 6] x [0, 5] x [0, 2.6].
Scenario l_shaped_room();

/// Another room, rectangular and furnished otherwise: 4.1 x 3.2 x 2.9 m.
Scenario other_room();

/// What a terrestrial scanner sees that stands upright at the place of a pose and gives its points
/// in the frame of the pose, turned in whatever way. `coarseness` as in Scenario: 8 is a ray per
/// 1.2 degrees.
Scan simulate_scan(const Scenario& room, const Transform& room_from_scan, std::uint64_t seed,
                   double coarseness = 8.0);

/// Points with what they are, in the room's frame.
struct LabelledCloud {
    PointCloud cloud;
    std::vector<Label> labels;
};

/// A furnished room of 5 x 4 x 2.7 m with its floor at z = 0 and a corner at the origin, seen from
/// three places: it has 4 walls, a door and a window.
LabelledCloud simulate_furnished_room(std::uint64_t seed, double coarseness = 6.0);

/// The scans that this cloud is made of, as the scanner left them: scan1.ply to scan3.ply.
std::vector<Scan> scan_furnished_room(std::uint64_t seed, double coarseness = 6.0);

}  // namespace roomscribe::test
