// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/window_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "roomscribe/interpretation/openings/wall_holes.hpp"

namespace roomscribe {
namespace {

/// m from the hole's sides. Frames are 50 to 120 mm wide; their outermost part may be the reveal's.
constexpr double ring_start = 0.02;
constexpr double ring_end = 0.07;
constexpr double widest_frame = 0.12;
/// m. Panes sit at least 12 mm behind the front of sash and frame.
constexpr double least_sinking = 0.01;
/// Fewer points are no layer.
constexpr std::size_t min_layer = 12;
/// Standard deviations to both sides of a layer.
constexpr double layer_deviations = 2.5;
/// m. Sash and frame are not in one plane.
constexpr double frame_relief = 0.02;
/// m. Narrower than the narrowest glazing bar (18 mm), wide enough for sides seen aslant.
constexpr double bar_cell = 0.02;
/// m. The frame's inner sides, seen aslant.
constexpr double rebate = 0.02;
/// m. A transom is lower.
constexpr double least_blind = 0.2;

/// The depth at which the most points lie within `reach`, if that are enough.
std::optional<double> densest_depth(std::vector<float> depths, double reach) {
    if (depths.size() < min_layer) return std::nullopt;
    std::sort(depths.begin(), depths.end());
    std::size_t best_first = 0;
    std::size_t best_count = 0;
    std::size_t last = 0;
    for (std::size_t first = 0; first < depths.size(); ++first) {
        while (last < depths.size() &&
               depths[last] - depths[first] <= static_cast<float>(2.0 * reach))
            ++last;
        if (last - first > best_count) {
            best_count = last - first;
            best_first = first;
        }
    }
    if (best_count < min_layer) return std::nullopt;
    return static_cast<double>(depths[best_first + best_count / 2]);
}

/// Places of the hole at which something was seen.
class CellMask {
  public:
    CellMask(const WindowHole& hole, double cell_size)
        : cell_size_(cell_size),
          columns_(std::max(1, static_cast<int>(std::ceil(hole.width / cell_size)))),
          rows_(std::max(1, static_cast<int>(std::ceil(hole.height / cell_size)))),
          marks_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    void mark(const HolePoint& point) {
        marks_[index(cell_of(point.along, columns_), cell_of(point.above, rows_))] = 1;
    }
    bool holds(int column, int row) const { return marks_[index(column, row)] != 0; }
    bool holds(const HolePoint& point) const {
        return holds(cell_of(point.along, columns_), cell_of(point.above, rows_));
    }

    /// Share of a row that is marked, without `margin` cells at either end.
    double share_of_row(int row, int margin) const {
        int count = 0;
        for (int column = margin; column < columns_ - margin; ++column)
            count += holds(column, row) ? 1 : 0;
        return columns_ > 2 * margin ? static_cast<double>(count) / (columns_ - 2 * margin) : 0.0;
    }

  private:
    int cell_of(float position, int count) const {
        return std::clamp(static_cast<int>(std::floor(position / static_cast<float>(cell_size_))),
                          0, count - 1);
    }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }

    double cell_size_;
    int columns_;
    int rows_;
    std::vector<std::uint8_t> marks_;
};

class WindowSorter {
  public:
    WindowSorter(std::span<const HolePoint> points, const WindowHole& hole, double noise)
        : points_(points),
          hole_(hole),
          reach_(std::max(layer_deviations * noise, 0.004)),
          frame_cells_(hole, bar_cell) {
        find_blind();
        frame_depth_ = densest_in_ring();
        find_pane();
        find_frame_cells();
    }

    WindowPart part_of(const HolePoint& point) const {
        const double inside = depth_inside(point);
        const double depth = point.depth;
        if (inside >= 0.0 && is_before_blind(point)) {
            const bool hides_frame = frame_depth_ - *blind_depth_ <= reach_;
            return inside > widest_frame || hides_frame ||
                           depth < 0.5 * (*blind_depth_ + frame_depth_)
                       ? WindowPart::pane
                       : WindowPart::frame;
        }
        // Beside the hole is the wall; only what lies in the depth of the hole can be in it.
        if (depth < frame_depth_ - frame_relief - reach_ || (inside < 0.0 && depth < reach_))
            return WindowPart::reveal;
        const bool is_at_pane = depth > 0.5 * (frame_depth_ + pane_depth_) &&
                                depth < pane_depth_ + std::max(reach_, least_sinking);
        const bool is_in_light = is_frame_dense_ ? inside > ring_start && !frame_cells_.holds(point)
                                                 : inside > hole_.frame_width + rebate;
        return is_at_pane && is_in_light ? WindowPart::pane : WindowPart::frame;
    }

  private:
    /// m from the nearest side of the hole.
    double depth_inside(const HolePoint& point) const {
        return std::min({static_cast<double>(point.along), hole_.width - point.along,
                         static_cast<double>(point.above), hole_.height - point.above});
    }
    bool is_in_ring(const HolePoint& point) const {
        const double inside = depth_inside(point);
        return inside >= ring_start && inside <= ring_end;
    }
    bool is_before_blind(const HolePoint& point) const {
        return blind_depth_ && point.above >= blind_bottom_;
    }

    /// A blind fills rows that lie one below another under the lintel.
    void find_blind() {
        constexpr double min_filled = 0.7;
        // Blind or frame, whichever shows along the sides, lies before the pane.
        const double front = densest_in_ring() + std::max(reach_, least_sinking);
        std::vector<HolePoint> before;
        for (const HolePoint& point : points_) {
            if (point.depth < front && depth_inside(point) >= 0.0) before.push_back(point);
        }
        if (before.size() < min_layer) return;
        // Four points to a cell, were they even.
        const double cell = std::clamp(
            2.0 * std::sqrt(hole_.width * hole_.height / static_cast<double>(before.size())),
            bar_cell, 0.5 * least_blind);
        CellMask filled(hole_, cell);
        for (const HolePoint& point : before)
            filled.mark(point);
        const int margin = static_cast<int>(std::ceil(widest_frame / cell));
        int row = filled.rows() - 1 - margin;
        while (row >= 0 && filled.share_of_row(row, margin) >= min_filled)
            --row;
        const double bottom = (row + 1) * cell;
        if (hole_.height - widest_frame - bottom < least_blind) return;
        std::vector<float> depths;
        for (const HolePoint& point : before) {
            if (point.above >= bottom && depth_inside(point) > widest_frame)
                depths.push_back(point.depth);
        }
        blind_depth_ = densest_depth(std::move(depths), reach_);
        blind_bottom_ = bottom;
    }

    double densest_in_ring() const {
        std::vector<float> depths;
        for (const HolePoint& point : points_) {
            if (is_in_ring(point) && !is_before_blind(point)) depths.push_back(point.depth);
        }
        return densest_depth(std::move(depths), reach_).value_or(hole_.frame_depth);
    }

    void find_pane() {
        const double start = frame_depth_ + std::max(least_sinking, reach_);
        std::vector<float> depths;
        for (const HolePoint& point : points_) {
            if (depth_inside(point) > widest_frame && point.depth > start &&
                point.depth < frame_depth_ + most_sinking)
                depths.push_back(point.depth);
        }
        pane_depth_ = densest_depth(std::move(depths), reach_)
                          .value_or(frame_depth_ + hole_.pane_depth - hole_.frame_depth);
    }

    /// The cells that the frame covers, if it was seen in most of those along the hole's sides
    /// that no blind hides.
    void find_frame_cells() {
        constexpr double min_seen = 0.7;
        for (const HolePoint& point : points_) {
            if (std::abs(point.depth - frame_depth_) <= frame_relief &&
                point.depth < 0.5 * (frame_depth_ + pane_depth_))
                frame_cells_.mark(point);
        }
        const int first = static_cast<int>(std::ceil(ring_start / bar_cell));
        const int columns = frame_cells_.columns();
        const int rows = frame_cells_.rows();
        int seen = 0;
        int total = 0;
        const auto count = [&](int column, int row) {
            if (blind_depth_ && (row + 1) * bar_cell > blind_bottom_) return;
            seen += frame_cells_.holds(column, row) ? 1 : 0;
            ++total;
        };
        if (columns <= 2 * first || rows <= 2 * first) return;
        for (int column = first; column < columns - first; ++column) {
            count(column, first);
            count(column, rows - 1 - first);
        }
        for (int row = first; row < rows - first; ++row) {
            count(first, row);
            count(columns - 1 - first, row);
        }
        is_frame_dense_ = total > 0 && seen >= min_seen * total;
    }

    std::span<const HolePoint> points_;
    WindowHole hole_;
    double reach_;
    std::optional<double> blind_depth_;
    double blind_bottom_ = 0.0;
    double frame_depth_ = 0.0;
    double pane_depth_ = 0.0;
    CellMask frame_cells_;
    bool is_frame_dense_ = false;
};

}  // namespace

std::vector<WindowPart> sort_window_points(std::span<const HolePoint> points,
                                           const WindowHole& hole, double noise) {
    const WindowSorter sorter(points, hole, noise);
    std::vector<WindowPart> parts;
    parts.reserve(points.size());
    for (const HolePoint& point : points)
        parts.push_back(sorter.part_of(point));
    return parts;
}

}  // namespace roomscribe
