// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/row_cuts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

namespace roomscribe {
namespace {

/// m: of the steps of the profile along the row.
constexpr double bin_width = 0.05;
/// m: the narrowest unit of a kitchen, and so much of a piece has to show on either side of a step.
constexpr double min_piece = 0.28;
/// m: tops of pieces that differ differ by more than a plate's thickness and noise.
constexpr double min_top_step = 0.08;
/// m: an overhang or a handle is not a step of the front.
constexpr double min_front_step = 0.08;
/// m: what rises higher behind that stands on the row.
constexpr double front_thickness = 0.1;
/// m: a row of less is one piece.
constexpr double min_row = 0.7;

/// Top and front of the row at places along it.
struct Profile {
    double start = 0.0;
    std::array<std::vector<double>, 2> lines;  ///< top, front; NaN where nothing was seen
};

Profile measure_profile(const FurnitureVoxels& all, std::span<const std::uint32_t> members,
                        const PlanRectangle& rectangle, const Eigen::Vector2d& to_front) {
    Profile profile;
    profile.start = rectangle.center.dot(rectangle.axis) - rectangle.length / 2.0;
    const auto num_bins = static_cast<std::size_t>(rectangle.length / bin_width) + 1;
    std::vector<std::vector<std::pair<double, double>>> values(num_bins);  // height, depth
    for (const std::uint32_t i : members) {
        const FurnitureVoxel& voxel = all.voxels[i];
        const double along = voxel.place.head<2>().dot(rectangle.axis) - profile.start;
        const auto bin = static_cast<std::size_t>(
            std::clamp(along / bin_width, 0.0, static_cast<double>(num_bins - 1)));
        values[bin].emplace_back(voxel.height, voxel.place.head<2>().dot(to_front));
    }
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    for (std::vector<std::pair<double, double>>& places : values) {
        // Not the outermost voxels, which may be strays.
        const bool is_seen = places.size() >= 3;
        std::vector<double> depths;
        depths.reserve(places.size());
        for (const auto& [height, depth] : places)
            depths.push_back(depth);
        const double front = is_seen ? quantile(depths, 0.95) : nothing;
        std::vector<double> heights;
        for (const auto& [height, depth] : places) {
            if (depth >= front - front_thickness) heights.push_back(height);
        }
        profile.lines[0].push_back(heights.size() >= 3 ? quantile(heights, 0.95) : nothing);
        profile.lines[1].push_back(front);
    }
    return profile;
}

/// The front is where most upright surface is: behind it little was seen.
Eigen::Vector2d direction_to_front(std::span<const Eigen::Vector2d> places,
                                   const PlanRectangle& rectangle) {
    const Eigen::Vector2d across = rectangle.across();
    std::size_t in_front = 0;
    for (const Eigen::Vector2d& place : places)
        in_front += (place - rectangle.center).dot(across) > 0.0 ? 1U : 0U;
    return 2 * in_front >= places.size() ? across : Eigen::Vector2d(-across);
}

/// How much the medians on both sides of a bin's lower edge differ.
double step_at(const std::vector<double>& line, std::size_t bin, std::size_t window) {
    std::array<std::vector<double>, 2> sides;
    for (std::size_t k = 0; k < window; ++k) {
        if (std::isfinite(line[bin - 1 - k])) sides[0].push_back(line[bin - 1 - k]);
        if (std::isfinite(line[bin + k])) sides[1].push_back(line[bin + k]);
    }
    if (2 * sides[0].size() < window || 2 * sides[1].size() < window) return 0.0;
    return std::abs(median(sides[0]) - median(sides[1]));
}

/// Whether boards run through a cut: level surface at two heights and more on both of its sides.
/// Pieces that stand side by side have their boards at heights of their own.
bool is_bridged_by_boards(const FurnitureVoxels& all, std::span<const std::uint32_t> members,
                          const Eigen::Vector2d& axis, double at) {
    constexpr double reach = 0.25;
    constexpr double slice = 0.03;    // m: a board's thickness
    constexpr double min_gap = 0.15;  // m: books are higher
    constexpr std::size_t few = 4;    // voxels of one board on one side
    std::map<std::int32_t, std::array<std::size_t, 2>> counts;
    for (const std::uint32_t i : members) {
        const FurnitureVoxel& voxel = all.voxels[i];
        const double along = voxel.place.head<2>().dot(axis) - at;
        if (!voxel.is_level || std::abs(along) > reach) continue;
        ++counts[static_cast<std::int32_t>(std::floor(voxel.height / slice))][along < 0.0 ? 0 : 1];
    }
    std::size_t boards = 0;
    double last = -1.0;
    for (const auto& [level, sides] : counts) {
        const double height = slice * level;
        if (std::min(sides[0], sides[1]) < few || height - last < min_gap) continue;
        last = height;
        ++boards;
    }
    return boards >= 2;
}

}  // namespace

double front_top(const FurnitureVoxels& all, std::span<const std::uint32_t> members) {
    const std::vector<Eigen::Vector2d> places = places_of(all, members);
    const PlanRectangle rectangle = smallest_rectangle(places);
    const Profile profile =
        measure_profile(all, members, rectangle, direction_to_front(places, rectangle));
    std::vector<double> tops;
    std::copy_if(profile.lines[0].begin(), profile.lines[0].end(), std::back_inserter(tops),
                 [](double top) { return std::isfinite(top); });
    return tops.empty() ? 0.0 : median(tops);
}

std::vector<std::vector<std::uint32_t>> cut_row(const FurnitureVoxels& all,
                                                std::span<const std::uint32_t> members) {
    const std::vector<Eigen::Vector2d> places = places_of(all, members);
    const PlanRectangle rectangle = smallest_rectangle(places);
    std::vector<std::vector<std::uint32_t>> parts;
    parts.emplace_back(members.begin(), members.end());
    if (rectangle.length < min_row) return parts;
    const Profile profile =
        measure_profile(all, members, rectangle, direction_to_front(places, rectangle));
    const std::size_t num_bins = profile.lines[0].size();
    const auto window = static_cast<std::size_t>(std::lround(min_piece / bin_width));
    double greatest = 1.0;
    std::size_t cut = 0;
    for (std::size_t bin = window; bin + window <= num_bins; ++bin) {
        const double step = std::max({step_at(profile.lines[0], bin, window) / min_top_step,
                                      step_at(profile.lines[1], bin, window) / min_front_step});
        if (step > greatest &&
            !is_bridged_by_boards(all, members, rectangle.axis,
                                  profile.start + bin_width * static_cast<double>(bin))) {
            greatest = step;
            cut = bin;
        }
    }
    if (cut == 0) return parts;
    const double at = profile.start + bin_width * static_cast<double>(cut);
    std::array<std::vector<std::uint32_t>, 2> sides;
    for (const std::uint32_t i : members)
        sides[all.voxels[i].place.head<2>().dot(rectangle.axis) < at ? 0 : 1].push_back(i);
    if (sides[0].empty() || sides[1].empty()) return parts;
    parts.clear();
    for (const std::vector<std::uint32_t>& side : sides) {
        for (std::vector<std::uint32_t>& part : cut_row(all, side))
            parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace roomscribe
