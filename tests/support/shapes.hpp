// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/transform.hpp"

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

}  // namespace roomscribe::test
