// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// In FloorPlan: no room.
inline constexpr std::int32_t no_room = -1;

/// Cells, within which what is seen of a ceiling is the one over a wall.
inline constexpr int ceiling_cells = 4;

/// A room as seen from above.
struct PlanRoom {
    double floor_height = 0.0;             ///< m along up
    std::optional<double> ceiling_height;  ///< median of what was seen of it, or the ridge
    std::optional<double> lowest_ceiling;  ///< 3 % of it is lower
};

/// The rooms of a storey in a raster seen from above. Places are x and y of the room frame without
/// its translation (Upright::room_from_map).
class FloorPlan {
  public:
    FloorPlan() = default;
    FloorPlan(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_size);

    double cell_size() const { return cell_size_; }
    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t num_cells() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }
    /// Number of the cell that holds the place, if there is one.
    std::optional<std::size_t> cell_at(const Eigen::Vector2d& place) const;
    Eigen::Vector2d middle_of(std::size_t cell) const;

    /// Number of the room at the place, or no_room.
    std::int32_t room_at(const Eigen::Vector2d& place) const;

    /// Whether something parts rooms there.
    bool is_barrier_at(const Eigen::Vector2d& place) const;
    /// Whether floor or ceiling was seen there.
    bool has_level_at(const Eigen::Vector2d& place) const;
    /// Height of the highest ceiling seen in the place's cell or within `reach` cells of it.
    std::optional<double> ceiling_near(const Eigen::Vector2d& place, int reach) const;
    /// Where the slope of a roof is lowest there; empty if some of the ceiling there is level.
    std::optional<double> slope_near(const Eigen::Vector2d& place, int reach) const;

    /// Whether `test(place)` holds anywhere from `nearest` to `farthest` m from a place in a
    /// direction, a unit vector, looked at a cell's width at a time.
    template <typename Test>
    bool any_along(const Eigen::Vector2d& place, const Eigen::Vector2d& direction, double nearest,
                   double farthest, Test&& test) const {
        for (double depth = nearest; depth <= farthest; depth += cell_size_) {
            if (test(Eigen::Vector2d(place + depth * direction))) return true;
        }
        return false;
    }

    /// Calls `visit(cell)` for a cell and all within `reach` cells of it, along rows and columns.
    template <typename Visit>
    void for_each_neighbor(std::size_t cell, int reach, Visit&& visit) const {
        const int x = static_cast<int>(cell % static_cast<std::size_t>(width_));
        const int y = static_cast<int>(cell / static_cast<std::size_t>(width_));
        for (int j = std::max(0, y - reach); j <= std::min(height_ - 1, y + reach); ++j) {
            for (int i = std::max(0, x - reach); i <= std::min(width_ - 1, x + reach); ++i) {
                visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(i));
            }
        }
    }

    std::vector<std::int32_t> room_of_cell;
    std::vector<bool> is_barrier;        ///< per cell
    std::vector<bool> has_level;         ///< per cell: floor or ceiling was seen
    std::vector<float> ceiling_of_cell;  ///< m along up, the highest seen in it; else NaN
    std::vector<bool> is_under_slope;    ///< per cell: of its ceiling only a roof's slope was seen
    std::vector<PlanRoom> rooms;

  private:
    Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
    double cell_size_ = 1.0;
    int width_ = 0;
    int height_ = 0;
};

}  // namespace roomscribe
