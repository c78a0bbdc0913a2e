// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/slab_cuts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"

namespace roomscribe {
namespace {

/// m: a piece of a row is not narrower than a kitchen's narrowest unit.
constexpr double min_part = 0.3;

/// m2 that a cut has to save: rims are not straight.
constexpr double cut_toll = 0.1;

/// Squares of the plan that a slab covers, along its rectangle.
class CoveredSquares {
  public:
    CoveredSquares(std::span<const Eigen::Vector2d> places, const PlanRectangle& rectangle,
                   double edge)
        : edge_(edge) {
        const Eigen::Vector2d half(0.5 * rectangle.length, 0.5 * rectangle.width);
        const auto squares = [&](double extent) { return static_cast<int>(extent / edge) + 1; };
        size_ = {squares(rectangle.length), squares(rectangle.width)};
        is_covered_.assign(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]),
                           false);
        for (const Eigen::Vector2d& place : places) {
            const Eigen::Vector2d from = place - rectangle.center;
            const Eigen::Vector2d at =
                (Eigen::Vector2d(from.dot(rectangle.axis), from.dot(rectangle.across())) + half) /
                edge;
            is_covered_[index(std::clamp(static_cast<int>(at.x()), 0, size_[0] - 1),
                              std::clamp(static_cast<int>(at.y()), 0, size_[1] - 1))] = true;
        }
    }

    /// Squares from `low` to before `high`, along and across.
    struct Window {
        std::array<int, 2> low{};
        std::array<int, 2> high{};
    };

    Window whole() const { return {{0, 0}, size_}; }

    /// What of a window is covered, tightly.
    Window bounds(const Window& window) const {
        Window tight{window.high, window.low};
        for (int y = window.low[1]; y < window.high[1]; ++y) {
            for (int x = window.low[0]; x < window.high[0]; ++x) {
                if (!is_covered_[index(x, y)]) continue;
                tight.low = {std::min(tight.low[0], x), std::min(tight.low[1], y)};
                tight.high = {std::max(tight.high[0], x + 1), std::max(tight.high[1], y + 1)};
            }
        }
        return tight;
    }

    double extent(const Window& window, std::size_t direction) const {
        return edge_ * std::max(0, window.high[direction] - window.low[direction]);
    }
    double area(const Window& window) const { return extent(window, 0) * extent(window, 1); }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_[0]) +
               static_cast<std::size_t>(x);
    }

    double edge_;
    std::array<int, 2> size_{};
    std::vector<bool> is_covered_;
};

/// The least area of rectangles that hold a window, cut up to `depth` times in a row from side to
/// side, and where its first cut lies. What fits a table is cut no further.
struct Partition {
    double area = 0.0;
    std::size_t direction = 0;
    int at = 0;
};

Partition best_partition(const CoveredSquares& squares, const CoveredSquares::Window& window,
                         double edge, int depth) {
    const CoveredSquares::Window tight = squares.bounds(window);
    Partition best{squares.area(tight), 0, 0};
    const std::array<double, 2> extents{squares.extent(tight, 0), squares.extent(tight, 1)};
    const bool fits = std::min(extents[0], extents[1]) <= max_table_width &&
                      std::max(extents[0], extents[1]) <= max_table_length;
    if (fits || depth == 0) return best;
    const int margin = static_cast<int>(std::ceil(min_part / edge));
    for (const std::size_t direction : {std::size_t{0}, std::size_t{1}}) {
        for (int at = tight.low[direction] + margin; at + margin <= tight.high[direction]; ++at) {
            CoveredSquares::Window low = tight;
            CoveredSquares::Window high = tight;
            low.high[direction] = at;
            high.low[direction] = at;
            const double area = best_partition(squares, low, edge, depth - 1).area +
                                best_partition(squares, high, edge, depth - 1).area + cut_toll;
            if (area < best.area) best = {area, direction, at};
        }
    }
    return best;
}

/// The best single cut, in rectangles that lie as they like.
SlabCut find_single_cut(std::span<const Eigen::Vector2d> places, const PlanRectangle& rectangle,
                        double step) {
    SlabCut best;
    best.area = rectangle.area();
    std::vector<Eigen::Vector2d> low;
    std::vector<Eigen::Vector2d> high;
    for (const Eigen::Vector2d& direction : {Eigen::Vector2d(rectangle.axis), rectangle.across()}) {
        const double extent = direction == rectangle.axis ? rectangle.length : rectangle.width;
        const double middle = rectangle.center.dot(direction);
        for (double at = middle - extent / 2.0 + min_part; at <= middle + extent / 2.0 - min_part;
             at += step) {
            low.clear();
            high.clear();
            for (const Eigen::Vector2d& place : places)
                (place.dot(direction) < at ? low : high).push_back(place);
            const double area = smallest_rectangle(low).area() + smallest_rectangle(high).area();
            if (area < best.area) best = {direction, at, area};
        }
    }
    return best;
}

/// A single cut, or the first of several where these hold the slab in less.
SlabCut find_cut(std::span<const Eigen::Vector2d> places, const PlanRectangle& rectangle,
                 double edge) {
    constexpr int max_depth = 2;
    SlabCut single = find_single_cut(places, rectangle, edge);
    const CoveredSquares squares(places, rectangle, edge);
    const Partition best = best_partition(squares, squares.whole(), edge, max_depth);
    if (single.area + cut_toll <= best.area) return single;
    const Eigen::Vector2d direction = best.direction == 0 ? rectangle.axis : rectangle.across();
    const double extent = best.direction == 0 ? rectangle.length : rectangle.width;
    return {direction, rectangle.center.dot(direction) - extent / 2.0 + edge * best.at, best.area};
}

/// Voxels below a top, at a line across it, of what stands there from the floor to the top: legs
/// and side panels, of which each of two tables that meet there has its own.
std::size_t count_supports(const FurnitureVoxels& all, const LevelSlab& slab, const SlabCut& cut) {
    constexpr double reach = 0.15;  // m: legs stand so near to a table's end
    constexpr double lowest = 0.1;
    constexpr double below_top = 0.12;
    constexpr double level_height = 0.1;
    constexpr double min_filled = 0.6;
    const double highest = slab.height - below_top;
    const FurnitureVoxel& some = all.voxels[slab.voxels.front()];
    std::vector<std::array<std::int32_t, 3>> marks;  // x, y, level
    for (const FurnitureVoxel& voxel : all.voxels) {
        if (voxel.room != some.room || voxel.storey != some.storey || !voxel.is_core) continue;
        if (voxel.height < lowest || voxel.height > highest) continue;
        const Eigen::Vector2d place = voxel.place.head<2>();
        if (std::abs(place.dot(cut.direction) - cut.at) > reach) continue;
        if (slab.rectangle.distance(place) > 0.0) continue;
        marks.push_back({static_cast<std::int32_t>(std::floor(place.x() / all.reach)),
                         static_cast<std::int32_t>(std::floor(place.y() / all.reach)),
                         static_cast<std::int32_t>((voxel.height - lowest) / level_height)});
    }
    std::sort(marks.begin(), marks.end());
    marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
    const double levels = std::max(1.0, (highest - lowest) / level_height);
    std::size_t supports = 0;
    for (std::size_t begin = 0, end = 0; begin < marks.size(); begin = end) {
        while (end < marks.size() && marks[end][0] == marks[begin][0] &&
               marks[end][1] == marks[begin][1])
            ++end;
        const auto filled = static_cast<double>(end - begin);
        supports += filled >= min_filled * levels ? end - begin : 0U;
    }
    return supports;
}

/// m: tables for meetings are up to 1.5 wide and 3.6 long.
constexpr double max_meeting_width = 1.5;
constexpr double max_meeting_length = 3.7;

/// Several desks side by side, whose tops are lower than a kitchen's worktop. Nothing if no leg
/// stands where they would meet and all could be one table.
std::optional<SlabCut> cut_desks(const FurnitureVoxels& all, const LevelSlab& slab) {
    constexpr double max_desk_height = 0.8;
    const PlanRectangle& rectangle = slab.rectangle;
    if (slab.height > max_desk_height || slab.height < min_table_height) return std::nullopt;
    if (rectangle.length <= max_table_length || rectangle.width > max_table_width) {
        return std::nullopt;
    }
    const double count = std::ceil(rectangle.length / max_table_length);
    const double start = rectangle.center.dot(rectangle.axis) - rectangle.length / 2.0;
    const SlabCut cut{rectangle.axis, start + rectangle.length / count, 0.0};
    constexpr double min_meeting_width = 0.9;
    const bool may_be_one =
        rectangle.width >= min_meeting_width && rectangle.length <= max_meeting_length;
    if (may_be_one && count_supports(all, slab, cut) == 0) return std::nullopt;
    return cut;
}

/// Voxels of chairs' size beside the ends of a cut: people sit along it.
std::size_t count_beside(const FurnitureVoxels& all, const PlanRectangle& rectangle,
                         const Eigen::Vector2d& across_cut, double half, double kept) {
    constexpr double chair_reach = 0.45;
    const Eigen::Vector2d along_cut(-across_cut.y(), across_cut.x());
    return static_cast<std::size_t>(
        std::count_if(all.voxels.begin(), all.voxels.end(), [&](const FurnitureVoxel& voxel) {
            if (!voxel.is_core || voxel.height < 0.35 || voxel.height > 1.15) return false;
            const Eigen::Vector2d from = voxel.place.head<2>() - rectangle.center;
            const double out = std::abs(from.dot(across_cut)) - half;
            return out >= 0.05 && out <= chair_reach && std::abs(from.dot(along_cut)) <= kept / 2.0;
        }));
}

/// Two tables, or rows of them, that face each other: halves of a table's depth. Where both ways to
/// halve it would do, people sit along the cut, so that chairs stand beside it. Nothing if no leg
/// stands along either and it could be one table for meetings.
std::optional<SlabCut> halve(const FurnitureVoxels& all, const LevelSlab& slab) {
    const PlanRectangle& rectangle = slab.rectangle;
    if (slab.height < min_table_height || rectangle.width <= max_table_width + 0.1)
        return std::nullopt;
    constexpr double min_half = 0.5;  // m: desks are 0.6 deep at least
    std::optional<SlabCut> best;
    std::size_t most = 0;
    std::size_t supports = 0;
    for (const bool is_long : {false, true}) {
        const Eigen::Vector2d direction = is_long ? rectangle.axis : rectangle.across();
        const double halved = is_long ? rectangle.length : rectangle.width;
        const double kept = is_long ? rectangle.width : rectangle.length;
        if (halved / 2.0 < min_half || halved / 2.0 > max_table_width) continue;
        if (is_long && kept > max_table_length) continue;
        const SlabCut cut{direction, rectangle.center.dot(direction), 0.0};
        supports += count_supports(all, slab, cut);
        const std::size_t beside = count_beside(all, rectangle, direction, halved / 2.0, kept);
        if (best && beside <= most) continue;
        most = beside;
        best = cut;
    }
    const bool may_be_one =
        rectangle.width <= max_meeting_width && rectangle.length <= max_meeting_length;
    return supports == 0 && may_be_one ? std::nullopt : best;
}

/// How much of a slab's depth is covered, in bins along a direction.
struct DepthProfile {
    double start = 0.0;  ///< m, along the direction
    double bin = 0.0;    ///< m
    std::vector<double> depths;
};

DepthProfile measure_depths(std::span<const Eigen::Vector2d> places,
                            const Eigen::Vector2d& direction, double bin, double edge) {
    const Eigen::Vector2d across(-direction.y(), direction.x());
    std::vector<std::pair<std::int32_t, std::int32_t>> cells;  // along, across
    for (const Eigen::Vector2d& place : places)
        cells.emplace_back(static_cast<std::int32_t>(std::floor(place.dot(direction) / bin)),
                           static_cast<std::int32_t>(std::floor(place.dot(across) / edge)));
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    const std::int32_t first = cells.front().first;
    DepthProfile profile{bin * first, bin, {}};
    profile.depths.assign(static_cast<std::size_t>(cells.back().first - first) + 1, 0.0);
    for (const auto& [along, beside] : cells)
        profile.depths[static_cast<std::size_t>(along - first)] += edge;
    return profile;
}

/// Seats of chairs side by side that noise ties together, or that stand askew and touch at a
/// corner: of a chair's size, with nearly nothing along a line between, where cushions of a sofa
/// touch along their depth.
std::optional<SlabCut> cut_seats(const FurnitureVoxels& all,
                                 std::span<const Eigen::Vector2d> places, const LevelSlab& slab,
                                 double voxel_size) {
    constexpr double min_seat = 0.3;
    constexpr double max_filled = 1.0 / 3.0;  // of the seats' depth; bins are wider than some gaps
    constexpr double max_row = 4.0;           // seats
    constexpr int max_turns = 4;              // either way, of chairs that stand askew
    const double turn = radians(5.0);
    const PlanRectangle& rectangle = slab.rectangle;
    // What stands askew takes the diagonal of a seat, or lies a little before its neighbour.
    const double max_width = std::sqrt(2.0) * max_seat_width;
    if (slab.height > max_seat || rectangle.width > max_width ||
        rectangle.length < 2.0 * min_seat || rectangle.length > max_row * max_seat_width) {
        return std::nullopt;
    }
    const double bin = 1.5 * std::max(voxel_size, 0.5 * all.reach);
    const auto margin = static_cast<std::size_t>(min_seat / bin);
    std::optional<SlabCut> best;
    double least = 1.0;
    for (int turns = -max_turns; turns <= max_turns; ++turns) {
        const Eigen::Vector2d direction = Eigen::Rotation2Dd(turn * turns) * rectangle.axis;
        const DepthProfile profile = measure_depths(places, direction, bin, voxel_size);
        std::vector<double> sorted = profile.depths;
        const double usual = median(sorted);
        for (std::size_t i = margin; i + margin < profile.depths.size(); ++i) {
            const double filled = profile.depths[i] / usual;
            if (filled > max_filled || filled >= least) continue;
            least = filled;
            best = SlabCut{direction, profile.start + bin * (static_cast<double>(i) + 0.5), 0.0};
        }
    }
    return best;
}

/// Two seats of which one stands a little before the other, so that no line is empty, but
/// rectangles around each leave out much of the one around both.
std::optional<SlabCut> cut_staggered_seats(std::span<const Eigen::Vector2d> places,
                                           const LevelSlab& slab, double step) {
    constexpr double max_share = 0.85;
    const PlanRectangle& rectangle = slab.rectangle;
    if (slab.height > max_seat || rectangle.length < 2.0 * min_part ||
        rectangle.length > 2.0 * max_seat_width) {
        return std::nullopt;
    }
    const SlabCut cut = find_single_cut(places, rectangle, step);
    if (cut.area > max_share * rectangle.area()) return std::nullopt;
    std::array<std::vector<Eigen::Vector2d>, 2> parts;
    for (const Eigen::Vector2d& place : places)
        parts[place.dot(cut.direction) < cut.at ? 0 : 1].push_back(place);
    const bool are_seats = std::all_of(parts.begin(), parts.end(), [](const auto& part) {
        const PlanRectangle seat = smallest_rectangle(part);
        return seat.length >= min_part && seat.length <= max_seat_width;
    });
    return are_seats ? std::optional(cut) : std::nullopt;
}

}  // namespace

std::optional<SlabCut> choose_slab_cut(const FurnitureVoxels& all,
                                       std::span<const Eigen::Vector2d> places,
                                       const LevelSlab& slab, double voxel_size) {
    const PlanRectangle& rectangle = slab.rectangle;
    if (std::optional<SlabCut> cut = cut_seats(all, places, slab, voxel_size)) return cut;
    if (std::optional<SlabCut> cut = cut_staggered_seats(places, slab, voxel_size)) return cut;
    if (rectangle.width <= max_table_width + 0.1) return cut_desks(all, slab);
    // What fills less than this of its rectangle is an L or several at angles.
    constexpr double min_fill = 0.8;
    if (slab.area < min_fill * rectangle.area()) {
        const SlabCut cut = find_cut(places, rectangle, 2.0 * voxel_size);
        if (cut.area < 0.9 * rectangle.area()) return cut;
    }
    return halve(all, slab);
}

}  // namespace roomscribe
