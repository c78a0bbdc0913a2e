// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe::test {

// Scans that nobody plans to make and everybody makes. All by the terrestrial scanner, a ray per
// degree or so, in the scanner's frame.

/// Where the scans of the l_shaped_room() are taken from (number 0 to 3), each with a heading and
/// lean of its own: room frame from the scan's.
Transform true_pose(std::size_t i);

/// One wall of 4 x 2.7 m, seen from 3 m, and nothing else.
std::vector<Scan> scan_lone_wall();

/// Level ground of 60 x 60 m with trees, bushes, a parked car and a fence.
std::vector<Scan> scan_outdoors();

/// A room of 5 x 4 x 2.6 m without door, window or furniture, from two places: it looks the same
/// turned by half a turn.
std::vector<Scan> scan_empty_room();

/// A flight of 14 steps of 29 x 18 cm between two walls, with a landing at its foot and its head.
std::vector<Scan> scan_staircase();

/// An office of 5 x 4 m, from inside it, whose long side is a glass partition (sill 0.3 m) to a
/// meeting room of 5 x 3 m behind.
std::vector<Scan> scan_through_glass();

/// The l_shaped_room() from four places; in those of odd number three people stand, each time
/// elsewhere.
std::vector<Scan> scan_moving_people();

/// Two scans of l_shaped_room(), then two of other_room().
std::vector<Scan> scan_two_buildings();

/// The l_shaped_room() from `count` places, at most 4.
std::vector<Scan> scan_l_shaped_room(std::size_t count);

/// A vase 30 cm high and as dense as a scanner of small things makes it: 1 mm.
Scan scan_of_object();

/// The same with x turned round: what a left-handed file gives.
void mirror(Scan& scan);

/// Puts this share of the points anywhere in the box of the scan, half as large again.
void scatter_outliers(Scan& scan, double share, Random& random);

/// This many of the finite points, drawn evenly.
Scan thinned_to(const Scan& scan, std::size_t count);

}  // namespace roomscribe::test
