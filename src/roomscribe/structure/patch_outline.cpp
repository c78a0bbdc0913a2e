// SPDX-License-Identifier: MIT
#include "roomscribe/structure/patch_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roomscribe {
namespace {

using Eigen::Vector2d;

constexpr std::size_t min_loop_cells = 8;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Which cells of a grid over the plane hold points.
class Raster {
  public:
    Raster(std::span<const Vector2d> points, double cell_size) : cell_size_(cell_size) {
        Vector2d high = points.front();
        low_ = high;
        for (const Vector2d& point : points) {
            low_ = low_.cwiseMin(point);
            high = high.cwiseMax(point);
        }
        // A margin lets every rim be walked around, and cells be closed at the border.
        low_.array() -= margin * cell_size;
        const Vector2d size = (high - low_) / cell_size;
        columns_ = static_cast<std::int32_t>(size.x()) + 1 + margin;
        rows_ = static_cast<std::int32_t>(size.y()) + 1 + margin;
        cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), false);
        for (const Vector2d& point : points)
            cells_[index_of(point)] = true;
    }

    std::int32_t columns() const { return columns_; }
    std::int32_t rows() const { return rows_; }
    std::size_t size() const { return cells_.size(); }
    std::size_t index(std::int32_t column, std::int32_t row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    std::size_t index_of(const Vector2d& point) const {
        const Vector2d place = (point - low_) / cell_size_;
        return index(static_cast<std::int32_t>(place.x()), static_cast<std::int32_t>(place.y()));
    }
    bool is_filled(std::int32_t column, std::int32_t row) const {
        return column >= 0 && row >= 0 && column < columns_ && row < rows_ &&
               cells_[index(column, row)];
    }

    std::size_t num_filled() const {
        return static_cast<std::size_t>(std::count(cells_.begin(), cells_.end(), true));
    }

    /// Whether the cells are too small for the points: many are empty between filled ones, or
    /// filled with hardly any neighbour.
    bool is_too_fine() const {
        constexpr double max_share = 0.02;
        constexpr int few_neighbors = 2;
        std::size_t num_filled = 0;
        std::size_t num_loose = 0;
        std::size_t num_between = 0;
        std::size_t num_gaps = 0;
        for (std::int32_t row = 0; row < rows_; ++row) {
            for (std::int32_t column = 0; column < columns_; ++column) {
                const bool filled = is_filled(column, row);
                num_filled += filled ? 1 : 0;
                num_loose += filled && num_neighbors(column, row) <= few_neighbors ? 1 : 0;
                const auto near = [&](std::int32_t x, std::int32_t y) {
                    return is_filled(column + x, row + y) || is_filled(column + 2 * x, row + 2 * y);
                };
                if (!(near(1, 0) && near(-1, 0) && near(0, 1) && near(0, -1))) continue;
                ++num_between;
                num_gaps += filled ? 0 : 1;
            }
        }
        return static_cast<double>(num_loose) > max_share * static_cast<double>(num_filled) ||
               static_cast<double>(num_gaps) > max_share * static_cast<double>(num_between);
    }

    /// Dilation and erosion by one cell.
    void close_gaps() {
        grow(true);
        grow(false);
    }

  private:
    static constexpr std::int32_t margin = 3;

    int num_neighbors(std::int32_t column, std::int32_t row) const {
        int count = 0;
        for (std::int32_t y = -1; y <= 1; ++y) {
            for (std::int32_t x = -1; x <= 1; ++x)
                count += (x != 0 || y != 0) && is_filled(column + x, row + y) ? 1 : 0;
        }
        return count;
    }

    void grow(bool value) {
        const std::vector<bool> before = cells_;
        for (std::int32_t row = 1; row + 1 < rows_; ++row) {
            for (std::int32_t column = 1; column + 1 < columns_; ++column) {
                if (before[index(column, row)] == value) continue;
                bool is_beside = false;
                for (std::int32_t y = -1; y <= 1; ++y) {
                    for (std::int32_t x = -1; x <= 1; ++x)
                        is_beside = is_beside || before[index(column + x, row + y)] == value;
                }
                if (is_beside) cells_[index(column, row)] = value;
            }
        }
    }

    double cell_size_;
    Vector2d low_;
    std::int32_t columns_ = 0;
    std::int32_t rows_ = 0;
    std::vector<bool> cells_;
};

/// Cells of which more than this many come on a point hold nothing between the points.
double least_cell_size(std::span<const Vector2d> points) {
    constexpr double max_cells_per_point = 16.0;
    Vector2d low = points.front();
    Vector2d high = low;
    for (const Vector2d& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    return std::sqrt((high - low).prod() /
                     (max_cells_per_point * static_cast<double>(points.size())));
}

/// The smallest cells in which the points leave hardly a gap.
Raster choose_raster(std::span<const Vector2d> points, double& cell_size) {
    constexpr double step = 1.4;
    constexpr int max_steps = 12;
    Raster raster(points, cell_size);
    for (int i = 0; i < max_steps && raster.is_too_fine(); ++i) {
        cell_size *= step;
        raster = Raster(points, cell_size);
    }
    return raster;
}

/// Walks along the sides of cells with the filled ones to the left.
class RimWalker {
  public:
    RimWalker(const Raster& raster, std::span<const Vector2d> points) : raster_(raster) {
        collect_rim_points(points);
        is_walked_.fill(std::vector<bool>(raster.size(), false));
    }

    std::vector<OutlineLoop> walk() {
        std::vector<OutlineLoop> loops;
        for (std::int32_t row = 0; row < raster_.rows(); ++row) {
            for (std::int32_t column = 0; column < raster_.columns(); ++column) {
                for (int side = 0; side < 4; ++side) {
                    if (!is_rim(column, row, side) ||
                        is_walked_[static_cast<std::size_t>(side)][raster_.index(column, row)]) {
                        continue;
                    }
                    add_loop({column, row, side}, loops);
                }
            }
        }
        return loops;
    }

  private:
    /// A side of a filled cell: 0 below, 1 right, 2 above, 3 left. It is walked counter-clockwise.
    struct Step {
        std::int32_t column;
        std::int32_t row;
        int side;
        bool operator==(const Step&) const = default;
    };

    static constexpr std::array<std::int32_t, 4> out_x{0, 1, 0, -1};
    static constexpr std::array<std::int32_t, 4> out_y{-1, 0, 1, 0};

    bool is_rim(std::int32_t column, std::int32_t row, int side) const {
        const auto s = static_cast<std::size_t>(side);
        return raster_.is_filled(column, row) &&
               !raster_.is_filled(column + out_x[s], row + out_y[s]);
    }

    /// Diagonal neighbours count as connected: closing left them so.
    Step next(const Step& step) const {
        const auto ahead = static_cast<std::size_t>((step.side + 1) % 4);
        const auto out = static_cast<std::size_t>(step.side);
        const std::int32_t diagonal_x = step.column + out_x[ahead] + out_x[out];
        const std::int32_t diagonal_y = step.row + out_y[ahead] + out_y[out];
        if (raster_.is_filled(diagonal_x, diagonal_y))
            return {diagonal_x, diagonal_y, (step.side + 3) % 4};
        const std::int32_t beside_x = step.column + out_x[ahead];
        const std::int32_t beside_y = step.row + out_y[ahead];
        if (raster_.is_filled(beside_x, beside_y)) return {beside_x, beside_y, step.side};
        return {step.column, step.row, (step.side + 1) % 4};
    }

    /// Points of cells that have an empty one beside them, by cell.
    void collect_rim_points(std::span<const Vector2d> points) {
        first_point_.assign(raster_.size(), none);
        next_point_.assign(points.size(), none);
        std::vector<bool> is_rim_cell(raster_.size(), false);
        for (std::int32_t row = 0; row < raster_.rows(); ++row) {
            for (std::int32_t column = 0; column < raster_.columns(); ++column) {
                for (int side = 0; side < 4; ++side) {
                    if (is_rim(column, row, side)) is_rim_cell[raster_.index(column, row)] = true;
                }
            }
        }
        points_ = points;
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            const std::size_t cell = raster_.index_of(points[i]);
            if (!is_rim_cell[cell]) continue;
            next_point_[i] = first_point_[cell];
            first_point_[cell] = i;
        }
    }

    std::uint32_t outermost(const Step& step) const {
        const auto s = static_cast<std::size_t>(step.side);
        const Vector2d out(out_x[s], out_y[s]);
        std::uint32_t best = none;
        std::uint32_t i = first_point_[raster_.index(step.column, step.row)];
        for (; i != none; i = next_point_[i]) {
            if (best == none || out.dot(points_[i]) > out.dot(points_[best])) best = i;
        }
        return best;
    }

    void add_loop(const Step& start, std::vector<OutlineLoop>& loops) {
        OutlineLoop loop;
        double turned = 0.0;
        std::size_t num_cells = 0;
        std::uint32_t last = none;
        Step step = start;
        do {
            is_walked_[static_cast<std::size_t>(step.side)][raster_.index(step.column, step.row)] =
                true;
            ++num_cells;
            const std::uint32_t point = outermost(step);
            if (point != none && point != last) {
                loop.points.push_back(points_[point]);
                last = point;
            }
            const Step following = next(step);
            const int turn = (following.side - step.side + 4) % 4;
            turned += turn == 1 ? 1.0 : (turn == 3 ? -1.0 : 0.0);
            step = following;
        } while (!(step == start));
        loop.is_hole = turned < 0.0;
        if (num_cells >= min_loop_cells && loop.points.size() >= 3)
            loops.push_back(std::move(loop));
    }

    const Raster& raster_;
    std::span<const Vector2d> points_;
    std::vector<std::uint32_t> first_point_;  ///< per cell
    std::vector<std::uint32_t> next_point_;   ///< per point: the next one of its cell
    std::array<std::vector<bool>, 4> is_walked_;
};

}  // namespace

PatchOutline trace_outline(std::span<const Eigen::Vector3f> positions,
                           std::span<const std::uint32_t> points, const Plane& plane,
                           double min_cell_size) {
    PatchOutline outline;
    if (points.empty()) return outline;
    const PlaneAxes axes = plane_axes(plane.normal);
    std::vector<Vector2d> places;
    places.reserve(points.size());
    for (const std::uint32_t point : points) {
        const Eigen::Vector3d position = positions[point].cast<double>();
        places.emplace_back(position.dot(axes.u), position.dot(axes.v));
    }
    outline.cell_size = std::max(min_cell_size, least_cell_size(places));
    Raster raster = choose_raster(places, outline.cell_size);
    raster.close_gaps();
    outline.spacing = outline.cell_size * std::sqrt(static_cast<double>(raster.num_filled()) /
                                                    static_cast<double>(places.size()));
    outline.loops = RimWalker(raster, places).walk();
    return outline;
}

}  // namespace roomscribe
