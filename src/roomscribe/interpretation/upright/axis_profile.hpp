// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/units.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// A patch is across or along an axis up to this angle: a third of the 45 degrees at which it would
/// be as near to the other.
inline constexpr double level_angle = radians(15.0);
/// m. A level is as thick as a step or a skirting; what lies higher is another level.
inline constexpr double level_thickness = 0.15;
/// Next to the largest level, what has less than this share of its area is furniture, not a floor:
/// a floor under furniture shows at least that much.
inline constexpr double level_share = 0.1;
/// m. Storeys are at least so high (building practice).
inline constexpr double min_storey_height = 2.0;

/// Roofs of dwellings rise by up to this much, from knee walls of at least this height (m): what is
/// steeper, or begins lower, is a wall that leans.
inline constexpr double max_roof_slope = radians(60.0);
inline constexpr double min_knee_height = 0.4;

/// A patch across the axis.
struct LevelPatch {
    double height;
    double area;
    double depth;          ///< m, the smaller extent
    std::uint32_t number;  ///< of the patch
};

/// A patch along the axis.
struct WallPatch {
    double bottom;
    double top;
    double area;
    double width;
};

/// The scene along one axis: what it would be like if the axis pointed up. Heights are positions
/// along it. The low and the high level are the lowest height in the lower half, and the highest in
/// the upper half, at which there is much planar surface across the axis.
struct AxisProfile {
    std::vector<LevelPatch> patches;  ///< those across the axis, by height
    std::vector<WallPatch> walls;     ///< those along it
    /// Share of the surface whose normal is neither along nor across the axis.
    double slanted_share = 0.0;
    /// Of the surface, in slopes that face each other and meet the high or the low level, as those
    /// of a roof meet the ceiling or the ridge.
    double roof_above = 0.0;
    double roof_below = 0.0;
    double area = 0.0;  ///< of the patches across
    std::optional<double> low;
    std::optional<double> high;
    double low_area = 0.0;
    double high_area = 0.0;
    double bottom = 0.0;                ///< 1 % of the surface indoors is lower
    double top = 0.0;                   ///< 1 % of it is higher
    std::vector<float> planar_heights;  ///< of the voxels of patches
    double clutter_below = 0.0;         ///< voxels of no patch in the lower half of the height
    double clutter_above = 0.0;

    double floor() const { return low.value_or(bottom); }
    double ceiling() const { return high.value_or(top); }
};

/// The points of no patch.
std::vector<Eigen::Vector3f> find_clutter(const SurfaceSample& sample,
                                          std::span<const PlanarPatch> patches);

AxisProfile profile_along(const Eigen::Vector3d& axis, const SurfaceSample& sample,
                          std::span<const PlanarPatch> patches,
                          std::span<const Eigen::Vector3f> clutter);

/// Turns the profile to that along the opposite direction.
void reverse(AxisProfile& profile);

/// Area across the axis between this height and a level's thickness above it.
double level_area(const AxisProfile& profile, double height);

/// Share of the clutter that has level surface closely under it: what it stands on.
double supported_share(std::span<const Eigen::Vector3f> clutter, const AxisProfile& profile,
                       const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                       const Eigen::Vector3d& up);

}  // namespace roomscribe
