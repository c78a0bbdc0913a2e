// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/walking_grid.hpp"

#include <algorithm>
#include <limits>

namespace roomscribe {
namespace {

using Eigen::Vector2d;

constexpr double cell_size = 0.1;
constexpr double walker_radius = 0.28;
constexpr double scanner_wall_distance = 0.9;
constexpr double scanner_item_distance = 0.4;
constexpr std::size_t min_scanner_cells = 12;

}  // namespace

WalkingGrid::WalkingGrid(const RoomPlan& room, std::span<const BuiltWallFace> walls,
                         std::span<const Eigen::Vector2d> entries) {
    const Eigen::AlignedBox2d bounds = bounds_of(room.outline);
    origin_ = bounds.min();
    columns_ = static_cast<std::size_t>(bounds.sizes().x() / cell_size) + 1;
    const auto rows = static_cast<std::size_t>(bounds.sizes().y() / cell_size) + 1;
    blocked_.assign(columns_ * rows, 1);
    is_roomy_.assign(blocked_.size(), 0);
    for (std::size_t cell = 0; cell < blocked_.size(); ++cell) {
        const Vector2d point = cell_center(cell);
        if (!contains(room.outline, point)) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (const BuiltWallFace& wall : walls)
            nearest = std::min(nearest, distance_to_segment(point, wall.start, wall.end));
        if (nearest < walker_radius) continue;
        blocked_[cell] = 0;
        ++num_walkable_;
        is_roomy_[cell] = nearest > scanner_wall_distance ? 1 : 0;
        num_roomy_ += is_roomy_[cell];
    }
    for (const Vector2d& entry : entries) {
        if (!contains(room.outline, entry)) continue;
        const std::size_t cell = cell_at(entry);
        if (blocked_[cell] == 0) entries_.push_back(cell);
    }
}

Vector2d WalkingGrid::cell_center(std::size_t cell) const {
    const std::size_t row = cell / columns_;
    const std::size_t column = cell % columns_;
    return origin_ +
           cell_size * Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
}

std::size_t WalkingGrid::cell_at(const Vector2d& point) const {
    const Vector2d offset = (point - origin_) / cell_size;
    return static_cast<std::size_t>(offset.y()) * columns_ + static_cast<std::size_t>(offset.x());
}

std::vector<std::uint8_t> WalkingGrid::reachable() const {
    std::vector<std::uint8_t> is_reached(blocked_.size(), 0);
    std::vector<std::size_t> queue;
    if (!entries_.empty()) {
        queue.push_back(entries_.front());
    } else {
        const auto first = std::find(blocked_.begin(), blocked_.end(), 0);
        if (first == blocked_.end()) return is_reached;
        queue.push_back(static_cast<std::size_t>(first - blocked_.begin()));
    }
    if (blocked_[queue.front()] != 0) return is_reached;
    is_reached[queue.front()] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const std::size_t cell = queue[i];
        const std::size_t column = cell % columns_;
        const auto visit = [&](std::size_t next) {
            if (blocked_[next] != 0 || is_reached[next] != 0) return;
            is_reached[next] = 1;
            queue.push_back(next);
        };
        if (column > 0) visit(cell - 1);
        if (column + 1 < columns_) visit(cell + 1);
        if (cell >= columns_) visit(cell - columns_);
        if (cell + columns_ < blocked_.size()) visit(cell + columns_);
    }
    return is_reached;
}

void WalkingGrid::take(const Footprint& obstacle) {
    for (std::size_t cell = 0; cell < blocked_.size(); ++cell) {
        if (blocked_[cell] == 0 && obstacle.distance(cell_center(cell)) < walker_radius) {
            blocked_[cell] = 1;
        }
    }
}

bool WalkingGrid::take_if_good(std::span<const Footprint> obstacles, double free_share) {
    const std::vector<std::uint8_t> before = blocked_;
    take(obstacles.back());
    const std::vector<std::uint8_t> is_reached = reachable();
    std::size_t num_reached = 0;
    std::size_t num_for_scanner = 0;
    for (std::size_t cell = 0; cell < blocked_.size(); ++cell) {
        num_reached += is_reached[cell];
        if (is_reached[cell] == 0 || is_roomy_[cell] == 0) continue;
        const Vector2d point = cell_center(cell);
        if (std::none_of(obstacles.begin(), obstacles.end(), [&](const Footprint& obstacle) {
                return obstacle.distance(point) < scanner_item_distance;
            })) {
            ++num_for_scanner;
        }
    }
    const bool joins_all_doors =
        std::all_of(entries_.begin(), entries_.end(),
                    [&](std::size_t entry) { return is_reached[entry] != 0; });
    if (!joins_all_doors ||
        static_cast<double>(num_reached) < free_share * static_cast<double>(num_walkable_) ||
        num_for_scanner < std::min(min_scanner_cells, num_roomy_)) {
        blocked_ = before;
        return false;
    }
    return true;
}

}  // namespace roomscribe
