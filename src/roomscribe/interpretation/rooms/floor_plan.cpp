// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/floor_plan.hpp"

#include <cmath>
#include <limits>

namespace roomscribe {

using Eigen::Vector2d;

FloorPlan::FloorPlan(const Vector2d& low, const Vector2d& high, double cell_size)
    : low_(low),
      cell_size_(cell_size),
      width_(static_cast<int>((high.x() - low.x()) / cell_size) + 1),
      height_(static_cast<int>((high.y() - low.y()) / cell_size) + 1) {
    room_of_cell.assign(num_cells(), no_room);
    is_barrier.assign(num_cells(), false);
    has_level.assign(num_cells(), false);
    ceiling_of_cell.assign(num_cells(), std::numeric_limits<float>::quiet_NaN());
    is_under_slope.assign(num_cells(), false);
}

std::optional<std::size_t> FloorPlan::cell_at(const Vector2d& place) const {
    const Vector2d offset = (place - low_) / cell_size_;
    if (!(offset.x() >= 0.0 && offset.y() >= 0.0 && offset.x() < width_ && offset.y() < height_))
        return std::nullopt;
    return static_cast<std::size_t>(offset.y()) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(offset.x());
}

Vector2d FloorPlan::middle_of(std::size_t cell) const {
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t row = cell / width;
    const std::size_t column = cell - row * width;
    return low_ +
           cell_size_ * Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
}

std::int32_t FloorPlan::room_at(const Vector2d& place) const {
    const auto cell = cell_at(place);
    return cell ? room_of_cell[*cell] : no_room;
}

bool FloorPlan::is_barrier_at(const Vector2d& place) const {
    const auto cell = cell_at(place);
    return cell && is_barrier[*cell];
}

bool FloorPlan::has_level_at(const Vector2d& place) const {
    const auto cell = cell_at(place);
    return cell && has_level[*cell];
}

std::optional<double> FloorPlan::ceiling_near(const Vector2d& place, int reach) const {
    const auto cell = cell_at(place);
    float highest = std::numeric_limits<float>::quiet_NaN();
    if (cell) {
        for_each_neighbor(*cell, reach, [&](std::size_t other) {
            if (!(highest >= ceiling_of_cell[other])) highest = ceiling_of_cell[other];
        });
    }
    if (std::isnan(highest)) return std::nullopt;
    return static_cast<double>(highest);
}

std::optional<double> FloorPlan::slope_near(const Vector2d& place, int reach) const {
    const auto cell = cell_at(place);
    if (!cell) return std::nullopt;
    float lowest = std::numeric_limits<float>::quiet_NaN();
    bool has_level_ceiling = false;
    for_each_neighbor(*cell, reach, [&](std::size_t other) {
        const float height = ceiling_of_cell[other];
        if (!is_under_slope[other]) {
            has_level_ceiling = has_level_ceiling || !std::isnan(height);
        } else if (!(lowest <= height)) {
            lowest = height;
        }
    });
    if (has_level_ceiling || std::isnan(lowest)) return std::nullopt;
    return static_cast<double>(lowest);
}

}  // namespace roomscribe
