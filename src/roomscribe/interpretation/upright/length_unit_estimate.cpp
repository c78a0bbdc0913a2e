// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/upright/length_unit_estimate.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/rooms/level_surfaces.hpp"
#include "roomscribe/interpretation/upright/upright.hpp"
#include "roomscribe/structure/plane_growing.hpp"
#include "roomscribe/structure/principal_axes.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {
namespace {

/// Half the points of a scan in metres are nearer to its middle, in all but the largest halls: the
/// ranges of a scanner indoors are a few metres, since rays that go far are few.
constexpr double surely_metres = 20.0;
/// Farther off than that, they are not indoors.
constexpr double hardly_metres = 100.0;
constexpr std::size_t max_points = 200'000;

// m. Storeys by building practice: 2.1 m is the least that codes allow for living rooms, offices
// have up to 4 m. Without a ceiling, scans of rooms still show furniture and walls.
constexpr double min_room_height = 2.1;
constexpr double max_room_height = 4.0;
constexpr double min_seen_height = 1.6;
/// m, of what may lie above a ceiling: voids, beams.
constexpr double max_above_ceiling = 0.5;
/// Share of what was seen of a building that is planar, and of this that lies along three axes, at
/// least.
constexpr double min_order = 0.5;
/// m above the floor, on a robot or on a tripod.
constexpr double min_scanner_height = 0.2;
constexpr double max_scanner_height = 2.2;

/// What a scan shows when it is read in some unit, in metres of this unit.
struct Reading {
    LengthUnit unit = LengthUnit::metre;
    std::optional<double> ceiling;  ///< above the floor
    double seen = 0.0;              ///< from the floor, or the lowest, to the highest surface
};

Scan even_share(const Scan& scan, std::size_t count) {
    std::vector<std::uint32_t> finite = finite_points(scan.cloud);
    if (finite.size() > count) {
        for (std::size_t i = 0; i < count; ++i)
            finite[i] = finite[i * finite.size() / count];
        finite.resize(count);
    }
    Scan share{scan.name, {}};
    for (const std::uint32_t point : finite)
        share.cloud.positions.push_back(scan.cloud.positions[point]);
    share.cloud.sensor_pose = scan.cloud.sensor_pose;
    return share;
}

bool is_within(double value, double low, double high) {
    return value >= low && value <= high;
}

/// What is between floor and ceiling along a direction that may be up.
Reading read_along(const Eigen::Vector3d& up, LengthUnit unit, const SurfaceSample& sample,
                   std::span<const PlanarPatch> patches) {
    Reading reading{unit, std::nullopt, 0.0};
    std::vector<double> heights;
    for (const PlanarPatch& patch : patches) {
        for (const std::uint32_t voxel : patch.points)
            heights.push_back(sample.cloud.positions[voxel].cast<double>().dot(up));
    }
    const double bottom = quantile(heights, 0.01);
    const double top = quantile(heights, 0.99);
    const Storey storey = find_storeys(sample, patches, up, false, {}).back();
    reading.seen = top - (storey.floor ? storey.floor->height : bottom);
    if (!storey.floor || storey.ceilings.empty()) return reading;
    const Level& ceiling =
        *std::max_element(storey.ceilings.begin(), storey.ceilings.end(),
                          [](const Level& a, const Level& b) { return a.area < b.area; });
    if (top - ceiling.height <= max_above_ceiling)
        reading.ceiling = ceiling.height - storey.floor->height;
    return reading;
}

bool shows_room(const Reading& reading) {
    return reading.ceiling && is_within(*reading.ceiling, min_room_height, max_room_height);
}

Reading read_in(LengthUnit unit, Scan scan, const Context& context) {
    const Reading nothing{unit, std::nullopt, 0.0};
    scale_in_place(scan.cloud, metres_per(unit));
    const ScanMap map = map_of_cloud(std::move(scan));
    const SurfaceSample sample =
        sample_surface(map, estimate_scan_statistics(map.cloud, context), {}, context);
    const std::vector<PlanarPatch> patches = grow_planar_patches(
        sample.cloud, {.distance_tolerance = sample.tolerance, .cell_size = 2.0 * sample.spacing},
        context);
    const PrincipalAxes axes = estimate_principal_axes(patches, {}, context);
    double area = 0.0;
    std::size_t num_planar = 0;
    for (const PlanarPatch& patch : patches) {
        area += patch.area;
        num_planar += patch.points.size();
    }
    const double planar_share = static_cast<double>(num_planar) /
                                static_cast<double>(std::max<std::size_t>(sample.cloud.size(), 1));
    const UprightSettings settings;
    if (area < settings.min_room_surface || std::min(axes.score, planar_share) < min_order)
        return nothing;
    const Upright upright = find_upright(sample, patches, axes, settings, context);
    // Of one scan it may not be clear which way is up: any that may be will do.
    Reading best = read_along(upright.candidates.front().up, unit, sample, patches);
    for (const UprightCandidate& candidate : upright.candidates) {
        if (shows_room(best)) break;
        if (upright.candidates.front().score - candidate.score > settings.ambiguous_margin) break;
        const Reading reading = read_along(candidate.up, unit, sample, patches);
        if (shows_room(reading)) best = reading;
    }
    return best;
}

/// The readings that show a building.
std::vector<Reading> plausible(std::span<const Reading> readings) {
    std::vector<Reading> result;
    std::copy_if(
        readings.begin(), readings.end(), std::back_inserter(result), [](const Reading& reading) {
            return reading.ceiling && is_within(*reading.ceiling, min_room_height, max_room_height);
        });
    const bool any_ceiling =
        std::any_of(readings.begin(), readings.end(),
                    [](const Reading& reading) { return reading.ceiling.has_value(); });
    if (any_ceiling) return result;
    std::copy_if(readings.begin(), readings.end(), std::back_inserter(result),
                 [](const Reading& reading) {
                     return is_within(reading.seen, min_seen_height, max_room_height);
                 });
    return result;
}

}  // namespace

LengthUnitEstimate estimate_length_unit(const Scan& scan, const Context& context) {
    LengthUnitEstimate estimate;
    estimate.median_distance = median_distance(scan.cloud.positions);
    if (estimate.median_distance <= surely_metres) return estimate;

    const Scan share = even_share(scan, max_points);
    std::vector<Reading> readings;
    for (const LengthUnit unit :
         {LengthUnit::metre, LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::inch}) {
        readings.push_back(read_in(unit, share, context));
    }
    const std::vector<Reading> fitting = plausible(readings);
    if (fitting.size() == 1 && fitting.front().unit != LengthUnit::metre) {
        const Reading& told = fitting.front();
        estimate.unit = told.unit;
        estimate.stop = LengthUnitStop::told;
        estimate.room_height = told.ceiling.value_or(told.seen);
        estimate.reason = fmt::format(
            "half of the points are more than {:.0f} from their middle, and in {} {}",
            estimate.median_distance, length_unit_word(told.unit),
            told.ceiling
                ? fmt::format("the ceiling is {:.2f} m above the floor", *told.ceiling)
                : fmt::format("what was seen reaches {:.2f} m above the floor", told.seen));
        return estimate;
    }
    const bool may_be_metres =
        fitting.empty() ? estimate.median_distance <= hardly_metres
                        : std::any_of(fitting.begin(), fitting.end(), [](const Reading& reading) {
                              return reading.unit == LengthUnit::metre;
                          });
    if (!may_be_metres) estimate.stop = LengthUnitStop::untold;
    return estimate;
}

bool may_be_feet(std::span<const Room> rooms, std::span<const double> sensor_heights) {
    const double feet = metres_per(LengthUnit::foot);
    return !rooms.empty() && std::all_of(rooms.begin(), rooms.end(), [&](const Room& room) {
        return is_within(feet * (room.ceiling_height - room.floor_height), min_room_height,
                         max_room_height);
    }) && std::all_of(sensor_heights.begin(), sensor_heights.end(), [&](double height) {
        return is_within(feet * height, min_scanner_height, max_scanner_height);
    });
}

}  // namespace roomscribe
