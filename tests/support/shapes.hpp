// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe::test {

/// Uniform among all directions.
Eigen::Vector3d random_direction(Random& random);

/// A turn uniform among all rotations, and a shift up to `max_shift` along each axis.
Transform random_transform(Random& random, double max_shift = 1.0);

/// A turn about any axis by `angle`, and a shift of length `shift` in any direction.
Transform small_transform(Random& random, double angle, double shift);

/// Uniform in the cube [-half_size, half_size]^3.
std::vector<Eigen::Vector3f> random_points(Random& random, std::size_t count,
                                           double half_size = 1.0);

/// rows x columns points `spacing` apart in the plane z = 0, from the origin on.
std::vector<Eigen::Vector3f> grid_points(std::size_t rows, std::size_t columns, double spacing);

/// Adds a normally distributed error to every coordinate.
void add_noise(std::vector<Eigen::Vector3f>& points, double deviation, Random& random);

std::vector<Eigen::Vector3f> transformed(const std::vector<Eigen::Vector3f>& points,
                                         const Transform& target_from_source);

/// Air bounded by walls, with solid boxes standing in it. The air is the union of boxes that
/// overlap or touch.
struct SimulatedRoom {
    std::vector<Eigen::AlignedBox3d> air;
    std::vector<Eigen::AlignedBox3d> solids;
};

/// A room of L shape with a table, a wardrobe, a shelf, a bed and smaller things: alike to itself
/// under no motion. Its floor is z = 0; it lies in [0, 6] x [0, 5] x [0, 2.6].
SimulatedRoom l_shaped_room();

/// Another room, rectangular and furnished otherwise: 4.1 x 3.2 x 2.9 m.
SimulatedRoom other_room();

struct ScannerPattern {
    std::size_t rows = 130;     ///< from straight down almost to straight up
    std::size_t columns = 280;  ///< all around
    double noise = 0.004;       ///< m, along the ray
};

/// What a scanner in the room sees, in its own frame.
Scan simulate_scan(const SimulatedRoom& room, const Transform& room_from_scan, std::uint64_t seed,
                   const ScannerPattern& pattern = {});

}  // namespace roomscribe::test
