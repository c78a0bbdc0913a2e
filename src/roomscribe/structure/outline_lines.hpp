// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/structure/patch_outline.hpp"

namespace roomscribe {

/// A straight stretch of an outline, in the plane's coordinates. It runs as the loop does: the
/// material lies to the left of start -> end.
struct OutlineLine {
    Eigen::Vector2d start = Eigen::Vector2d::Zero();
    Eigen::Vector2d end = Eigen::Vector2d::Zero();
    std::uint32_t loop = 0;
    std::uint32_t num_points = 0;  ///< rim points along it
    double rms = 0.0;              ///< m, of these about it

    double length() const { return (end - start).norm(); }
    Eigen::Vector2d direction() const { return (end - start).normalized(); }
};

struct OutlineLineSettings {
    double tolerance = 0.01;   ///< m: rim points lie no further from their line
    double min_length = 0.10;  ///< m
};

/// The straight stretches of all loops: each loop is split where it strays furthest from the chord
/// (Douglas and Peucker 1973), each stretch is fitted by least squares without its ends, where
/// corners are rounded off, and moved out by half the spacing of the points, which is how far the
/// last row lies before the rim; neighbouring stretches that are one line are joined. In the order
/// of the loops.
std::vector<OutlineLine> find_outline_lines(const PatchOutline& outline,
                                            const OutlineLineSettings& settings = {});

}  // namespace roomscribe
