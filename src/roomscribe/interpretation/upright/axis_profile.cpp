// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/upright/axis_profile.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

constexpr double plan_cell = 0.25;
/// Small things stand within a hand's breadth and are about a bottle high.
constexpr double support_cell = 0.1;
constexpr float max_support_distance = 0.3F;
/// Fewer points than this are strays: their share counts in proportion.
constexpr std::size_t min_clutter = 100;

/// The lowest height, in the lower half, at which there is much surface across the axis.
void find_low_level(AxisProfile& profile) {
    double largest = 0.0;
    for (const LevelPatch& patch : profile.patches) {
        largest = std::max(largest, level_area(profile, patch.height));
    }
    for (const LevelPatch& patch : profile.patches) {
        if (patch.height > 0.5 * (profile.bottom + profile.top)) return;
        const double area = level_area(profile, patch.height);
        if (area < level_share * largest) continue;
        profile.low = patch.height;
        profile.low_area = area;
        return;
    }
}

void add_patch(AxisProfile& profile, const SurfaceSample& sample, const PlanarPatch& patch,
               std::uint32_t number, const Eigen::Vector3d& axis) {
    const double cosine = patch.plane.normal.dot(axis);
    std::vector<float> heights;
    heights.reserve(patch.points.size());
    const Eigen::Vector3f direction = axis.cast<float>();
    for (const std::uint32_t point : patch.points) {
        heights.push_back(sample.cloud.positions[point].dot(direction));
    }
    profile.planar_heights.insert(profile.planar_heights.end(), heights.begin(), heights.end());
    if (std::abs(cosine) >= std::cos(level_angle)) {
        const auto fit = fit_plane(sample.cloud.positions, patch.points);
        // The extent of an even spread is the square root of 12 times its standard deviation.
        const double depth = fit ? std::sqrt(12.0 * fit->variances[1]) : 0.0;
        profile.patches.push_back({patch.centroid.dot(axis), patch.area, depth, number});
        profile.area += patch.area;
    } else if (std::abs(cosine) <= std::sin(level_angle)) {
        const double bottom = static_cast<double>(quantile(heights, 0.01));
        const double top = static_cast<double>(quantile(heights, 0.99));
        profile.walls.push_back(
            {bottom, top, patch.area, patch.area / std::max(top - bottom, 1e-6)});
    }
}

using PlanCell = std::pair<std::int32_t, std::int32_t>;

PlanCell plan_cell_of(const Eigen::Vector3f& point, const PlaneAxes& plan, double cell_size) {
    const Eigen::Vector3d position = point.cast<double>();
    return {static_cast<std::int32_t>(std::floor(position.dot(plan.u) / cell_size)),
            static_cast<std::int32_t>(std::floor(position.dot(plan.v) / cell_size))};
}

/// The heights of all surface across the axis, by square of the plan.
std::vector<std::pair<PlanCell, float>> level_heights(const AxisProfile& profile,
                                                      const SurfaceSample& sample,
                                                      std::span<const PlanarPatch> patches,
                                                      const Eigen::Vector3d& axis,
                                                      double cell_size) {
    const PlaneAxes plan = plane_axes(axis);
    const auto direction = axis.cast<float>();
    std::vector<std::pair<PlanCell, float>> heights;
    for (const LevelPatch& patch : profile.patches) {
        for (const std::uint32_t number : patches[patch.number].points) {
            const Eigen::Vector3f& point = sample.cloud.positions[number];
            heights.emplace_back(plan_cell_of(point, plan, cell_size),
                                 point.dot(Eigen::Vector3f(direction)));
        }
    }
    std::sort(heights.begin(), heights.end());
    return heights;
}

/// Counts the clutter in the lower and in the upper half of the height, each in its square of the
/// plan between the lowest and the highest level surface there, or between the levels, where these
/// are not a room's height apart. Clutter with no level surface over or under it is seen through
/// windows and doors and no evidence.
void count_clutter(AxisProfile& profile, const SurfaceSample& sample,
                   std::span<const PlanarPatch> patches, std::span<const Eigen::Vector3f> clutter,
                   const Eigen::Vector3d& axis) {
    const auto heights = level_heights(profile, sample, patches, axis, plan_cell);
    const PlaneAxes plan = plane_axes(axis);
    const auto direction = axis.cast<float>();
    const auto by_cell = [](const auto& a, const auto& b) { return a.first < b.first; };
    for (const Eigen::Vector3f& point : clutter) {
        const PlanCell cell = plan_cell_of(point, plan, plan_cell);
        const auto [first, last] =
            std::equal_range(heights.begin(), heights.end(), std::pair(cell, 0.0F), by_cell);
        if (first == last) continue;
        auto floor = static_cast<double>(first->second);
        auto ceiling = static_cast<double>((last - 1)->second);
        if (ceiling - floor < min_storey_height) {
            floor = profile.floor();
            ceiling = profile.ceiling();
        }
        const auto height = static_cast<double>(point.dot(Eigen::Vector3f(direction)));
        const double middle = 0.5 * (floor + ceiling);
        if (height > floor && height < middle) ++profile.clutter_below;
        if (height > middle && height < ceiling) ++profile.clutter_above;
    }
}

/// Share of a patch's voxels that have other surface across the axis a room's height over or under
/// them. `heights` are level_heights() in squares of plan_cell.
double covered_share(const PlanarPatch& patch, const SurfaceSample& sample,
                     std::span<const std::pair<PlanCell, float>> heights,
                     const Eigen::Vector3d& axis) {
    const PlaneAxes plan = plane_axes(axis);
    const auto direction = axis.cast<float>();
    const auto by_cell = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::size_t num_covered = 0;
    for (const std::uint32_t number : patch.points) {
        const Eigen::Vector3f& point = sample.cloud.positions[number];
        const auto height = static_cast<double>(point.dot(Eigen::Vector3f(direction)));
        const auto [first, last] =
            std::equal_range(heights.begin(), heights.end(),
                             std::pair(plan_cell_of(point, plan, plan_cell), 0.0F), by_cell);
        const double lowest = static_cast<double>(first->second);
        const double highest = static_cast<double>((last - 1)->second);
        if (std::max(height - lowest, highest - height) >= min_storey_height) ++num_covered;
    }
    return static_cast<double>(num_covered) / static_cast<double>(patch.points.size());
}

void set_extent(AxisProfile& profile, std::vector<float> heights) {
    profile.bottom = static_cast<double>(quantile(heights, 0.01));
    profile.top = static_cast<double>(quantile(heights, 0.99));
}

/// Leaves out what is lower, or higher, than all that has level surface a room's height over or
/// under it: the ground and the roofs that are seen through the windows of an upper storey. Where
/// little has, as where no ceiling was seen, all stays.
void drop_outdoors(AxisProfile& profile, const SurfaceSample& sample,
                   std::span<const PlanarPatch> patches, const Eigen::Vector3d& axis) {
    const auto heights = level_heights(profile, sample, patches, axis, plan_cell);
    std::optional<double> low;
    std::optional<double> high;
    double covered_area = 0.0;
    for (const LevelPatch& patch : profile.patches) {
        if (covered_share(patches[patch.number], sample, heights, axis) < level_share) continue;
        covered_area += patch.area;
        low = std::min(low.value_or(patch.height), patch.height);
        high = std::max(high.value_or(patch.height), patch.height);
    }
    if (!low || 2.0 * covered_area < profile.area) return;
    const double bottom = *low - level_thickness;
    const double top = *high + level_thickness;
    std::erase_if(profile.patches, [&](const LevelPatch& patch) {
        return patch.height < bottom || patch.height > top;
    });
    std::vector<float> indoors;
    std::copy_if(profile.planar_heights.begin(), profile.planar_heights.end(),
                 std::back_inserter(indoors), [&](float height) {
                     return static_cast<double>(height) >= bottom &&
                            static_cast<double>(height) <= top;
                 });
    set_extent(profile, std::move(indoors));
    profile.area = 0.0;
    for (const LevelPatch& patch : profile.patches)
        profile.area += patch.area;
}

/// Share of the surface whose normal is neither along nor across the axis.
double slanted_share(const SurfaceSample& sample, const Eigen::Vector3d& axis) {
    const auto direction = axis.cast<float>();
    const auto from = static_cast<float>(std::sin(level_angle));
    const auto to = static_cast<float>(std::cos(level_angle));
    std::size_t slanted = 0;
    std::size_t total = 0;
    for (const Eigen::Vector3f& normal : sample.cloud.normals) {
        const float cosine = std::abs(normal.dot(Eigen::Vector3f(direction)));
        if (!std::isfinite(cosine)) continue;
        ++total;
        if (cosine > from && cosine < to) ++slanted;
    }
    return static_cast<double>(slanted) / static_cast<double>(std::max<std::size_t>(total, 1));
}

/// A slanted patch; the normal is that of the side that looks along the axis.
struct Slope {
    Eigen::Vector3d normal;
    double bottom;
    double top;
    std::size_t size;
};

std::vector<Slope> find_slopes(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                               const Eigen::Vector3d& axis) {
    const auto direction = axis.cast<float>();
    std::vector<Slope> slopes;
    for (const PlanarPatch& patch : patches) {
        const double cosine = patch.plane.normal.dot(axis);
        if (std::abs(cosine) >= std::cos(level_angle)) continue;
        if (std::abs(cosine) <= std::cos(max_roof_slope)) continue;
        std::vector<float> heights;
        for (const std::uint32_t point : patch.points)
            heights.push_back(sample.cloud.positions[point].dot(Eigen::Vector3f(direction)));
        const Eigen::Vector3d normal = cosine < 0.0 ? -patch.plane.normal : patch.plane.normal;
        slopes.push_back({normal, static_cast<double>(quantile(heights, 0.01)),
                          static_cast<double>(quantile(heights, 0.99)), patch.points.size()});
    }
    return slopes;
}

/// Share of the surface in those slopes of `has_place` that have one of equal pitch on the other
/// side: roofs have two. A single slanted wall is none, along whichever axis it is looked at.
template <typename HasPlace>
double paired_share(std::span<const Slope> slopes, const Eigen::Vector3d& axis,
                    std::size_t num_voxels, HasPlace&& has_place) {
    const double cosine = std::cos(level_angle);
    std::size_t paired = 0;
    for (const Slope& slope : slopes) {
        if (!has_place(slope)) continue;
        const Eigen::Vector3d opposite = 2.0 * slope.normal.dot(axis) * axis - slope.normal;
        const bool has_pair = std::any_of(slopes.begin(), slopes.end(), [&](const Slope& other) {
            return has_place(other) && other.normal.dot(opposite) >= cosine;
        });
        paired += has_pair ? slope.size : 0;
    }
    return static_cast<double>(paired) / static_cast<double>(std::max<std::size_t>(num_voxels, 1));
}

/// Roofs begin at a knee wall and end at the level part of the ceiling, or at the ridge.
void find_roofs(AxisProfile& profile, const SurfaceSample& sample,
                std::span<const PlanarPatch> patches, const Eigen::Vector3d& axis) {
    constexpr double max_gap = 0.3;
    const std::vector<Slope> slopes = find_slopes(sample, patches, axis);
    profile.roof_above = paired_share(slopes, axis, sample.cloud.size(), [&](const Slope& slope) {
        return slope.top >= profile.ceiling() - max_gap &&
               slope.bottom >= profile.floor() + min_knee_height;
    });
    profile.roof_below = paired_share(slopes, axis, sample.cloud.size(), [&](const Slope& slope) {
        return slope.bottom <= profile.floor() + max_gap &&
               slope.top <= profile.ceiling() - min_knee_height;
    });
}

}  // namespace

double level_area(const AxisProfile& profile, double height) {
    double area = 0.0;
    for (const LevelPatch& patch : profile.patches) {
        if (patch.height >= height && patch.height <= height + level_thickness) area += patch.area;
    }
    return area;
}

void reverse(AxisProfile& profile) {
    std::reverse(profile.patches.begin(), profile.patches.end());
    for (LevelPatch& patch : profile.patches) {
        patch.height = -patch.height;
    }
    for (WallPatch& wall : profile.walls) {
        wall = {-wall.top, -wall.bottom, wall.area, wall.width};
    }
    const auto negated = [](std::optional<double> height) {
        return height ? std::optional(-*height) : std::nullopt;
    };
    const auto low = profile.low;
    profile.low = negated(profile.high);
    profile.high = negated(low);
    std::swap(profile.low_area, profile.high_area);
    const double bottom = profile.bottom;
    profile.bottom = -profile.top;
    profile.top = -bottom;
    for (float& height : profile.planar_heights)
        height = -height;
    std::swap(profile.clutter_below, profile.clutter_above);
    std::swap(profile.roof_below, profile.roof_above);
}

std::vector<Eigen::Vector3f> find_clutter(const SurfaceSample& sample,
                                          std::span<const PlanarPatch> patches) {
    std::vector<bool> is_planar(sample.cloud.size(), false);
    for (const PlanarPatch& patch : patches) {
        for (const std::uint32_t point : patch.points)
            is_planar[point] = true;
    }
    std::vector<Eigen::Vector3f> clutter;
    for (std::size_t i = 0; i < is_planar.size(); ++i) {
        if (!is_planar[i]) clutter.push_back(sample.cloud.positions[i]);
    }
    return clutter;
}

double supported_share(std::span<const Eigen::Vector3f> clutter, const AxisProfile& profile,
                       const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                       const Eigen::Vector3d& up) {
    const auto tops = level_heights(profile, sample, patches, up, support_cell);
    const PlaneAxes plan = plane_axes(up);
    const auto direction = up.cast<float>();
    std::size_t supported = 0;
    for (const Eigen::Vector3f& point : clutter) {
        const float height = point.dot(Eigen::Vector3f(direction));
        const std::pair lowest(plan_cell_of(point, plan, support_cell),
                               height - max_support_distance);
        const auto top = std::lower_bound(tops.begin(), tops.end(), lowest);
        if (top != tops.end() && top->first == lowest.first && top->second < height) ++supported;
    }
    return static_cast<double>(supported) /
           static_cast<double>(std::max<std::size_t>(clutter.size(), min_clutter));
}

AxisProfile profile_along(const Eigen::Vector3d& axis, const SurfaceSample& sample,
                          std::span<const PlanarPatch> patches,
                          std::span<const Eigen::Vector3f> clutter) {
    AxisProfile profile;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        add_patch(profile, sample, patches[i], i, axis);
    }
    profile.slanted_share = slanted_share(sample, axis);
    std::stable_sort(profile.patches.begin(), profile.patches.end(),
                     [](const LevelPatch& a, const LevelPatch& b) { return a.height < b.height; });
    set_extent(profile, profile.planar_heights);
    drop_outdoors(profile, sample, patches, axis);
    find_low_level(profile);
    reverse(profile);
    find_low_level(profile);
    reverse(profile);
    count_clutter(profile, sample, patches, clutter, axis);
    find_roofs(profile, sample, patches, axis);
    return profile;
}

}  // namespace roomscribe
