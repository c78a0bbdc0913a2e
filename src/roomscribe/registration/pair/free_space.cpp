// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/free_space.hpp"

#include <algorithm>
#include <cmath>

namespace roomscribe {
namespace {

constexpr int min_seen = 5;  // the majority of a full neighbourhood

std::size_t stride_for(std::size_t num_points, std::size_t num_wanted) {
    return std::max<std::size_t>(1, num_points / num_wanted);
}

}  // namespace

FreeSpace::FreeSpace(std::span<const Eigen::Vector3f> positions,
                     const Eigen::Vector3d& sensor_position, double points_per_cell)
    : sensor_position_(sensor_position) {
    // From 0.25 degrees, which gains nothing indoors, to 5 degrees, which sees no room any more.
    constexpr int finest = 360;
    constexpr int coarsest = 18;
    cells_per_edge_ = finest;
    // An occupied cell holds a point at least: how thin a scan is shows only once cells are shared.
    double occupancy = fill(positions);
    while (occupancy < points_per_cell && cells_per_edge_ > coarsest) {
        const double factor = std::min(0.9, std::sqrt(occupancy / points_per_cell));
        cells_per_edge_ = std::max(coarsest, static_cast<int>(factor * cells_per_edge_));
        occupancy = fill(positions);
    }
    // Cells that are finer than the rings of a spinning scanner lie apart. Of a grid's, nine in ten
    // and more touch enough others.
    constexpr double min_touching = 0.8;
    constexpr double next_factor = 0.8;
    while (share_of_touching_cells() < min_touching && cells_per_edge_ > coarsest) {
        cells_per_edge_ = std::max(coarsest, static_cast<int>(next_factor * cells_per_edge_));
        fill(positions);
    }
}

double FreeSpace::share_of_touching_cells() const {
    std::size_t num_occupied = 0;
    std::size_t num_touching = 0;
    for (int face = 0; face < 6; ++face) {
        for (int row = 0; row < cells_per_edge_; ++row) {
            for (int column = 0; column < cells_per_edge_; ++column) {
                if (cells_[index_of({face, row, column})].nearest == 0.0F) continue;
                ++num_occupied;
                num_touching += look_around({face, row, column}).num_seen >= min_seen ? 1 : 0;
            }
        }
    }
    return num_occupied == 0
               ? 1.0
               : static_cast<double>(num_touching) / static_cast<double>(num_occupied);
}

double FreeSpace::fill(std::span<const Eigen::Vector3f> positions) {
    const auto edge = static_cast<std::size_t>(cells_per_edge_);
    cells_.assign(6 * edge * edge, Cell{});
    std::size_t num_points = 0;
    std::size_t num_occupied = 0;
    // Enough for a few points in each of the finest cells; more would say the same.
    const std::size_t stride = stride_for(positions.size(), 1'000'000);
    for (std::size_t i = 0; i < positions.size(); i += stride) {
        const Eigen::Vector3d ray = positions[i].cast<double>() - sensor_position_;
        const auto range = static_cast<float>(ray.norm());
        if (!std::isfinite(range) || range == 0.0F) continue;
        Cell& cell = cells_[index_of(place_of(ray))];
        ++num_points;
        if (cell.nearest == 0.0F) ++num_occupied;
        cell.nearest = cell.nearest == 0.0F ? range : std::min(cell.nearest, range);
        cell.farthest = std::max(cell.farthest, range);
    }
    return num_occupied == 0 ? 0.0
                             : static_cast<double>(num_points) / static_cast<double>(num_occupied);
}

std::size_t FreeSpace::index_of(const CellPlace& place) const {
    const int index = (place.face * cells_per_edge_ + place.row) * cells_per_edge_ + place.column;
    return static_cast<std::size_t>(index);
}

FreeSpace::CellPlace FreeSpace::place_of(const Eigen::Vector3d& direction) const {
    Eigen::Index axis = 0;
    const double largest = direction.cwiseAbs().maxCoeff(&axis);
    const auto cell_of = [&](double coordinate) {
        const double share = 0.5 * (coordinate / largest + 1.0);
        return std::clamp(static_cast<int>(share * cells_per_edge_), 0, cells_per_edge_ - 1);
    };
    return {static_cast<int>(axis) + (direction[axis] < 0.0 ? 3 : 0),
            cell_of(direction[(axis + 1) % 3]), cell_of(direction[(axis + 2) % 3])};
}

FreeSpace::Neighborhood FreeSpace::look_around(const CellPlace& center) const {
    Neighborhood found;
    for (int row = std::max(center.row - 1, 0);
         row <= std::min(center.row + 1, cells_per_edge_ - 1); ++row) {
        for (int column = std::max(center.column - 1, 0);
             column <= std::min(center.column + 1, cells_per_edge_ - 1); ++column) {
            const Cell& cell = cells_[index_of({center.face, row, column})];
            if (cell.nearest == 0.0F) continue;
            found.nearest =
                found.num_seen == 0 ? cell.nearest : std::min(found.nearest, cell.nearest);
            found.farthest = std::max(found.farthest, cell.farthest);
            ++found.num_seen;
        }
    }
    return found;
}

Visibility FreeSpace::look_at(const Eigen::Vector3d& place, double margin) const {
    const Eigen::Vector3d ray = place - sensor_position_;
    const double range = ray.norm();
    if (!(range > 0.0)) return Visibility::unseen;
    const Neighborhood seen = look_around(place_of(ray));
    if (seen.num_seen < min_seen) return Visibility::unseen;
    if (range < static_cast<double>(seen.nearest) - margin) return Visibility::free;
    if (range > static_cast<double>(seen.farthest) + margin) return Visibility::hidden;
    return Visibility::surface;
}

double self_contradiction(std::span<const Eigen::Vector3f> positions,
                          const Eigen::Vector3d& sensor_position, double margin) {
    // Two points in a cell are enough to contradict each other; wider cells mix rims.
    const FreeSpace narrow(positions, sensor_position, 2.0);
    std::size_t num_contradicted = 0;
    std::size_t num_looked_at = 0;
    const std::size_t stride = stride_for(positions.size(), 100'000);  // for a share, plenty
    for (std::size_t i = 0; i < positions.size(); i += stride) {
        if (!positions[i].allFinite()) continue;
        const Eigen::Vector3d ray = positions[i].cast<double>() - sensor_position;
        const FreeSpace::Cell& cell = narrow.cells_[narrow.index_of(narrow.place_of(ray))];
        ++num_looked_at;
        // A grazing angle spreads the ranges within a cell; a tenth allows for it.
        if (ray.norm() > 1.1 * static_cast<double>(cell.nearest) + margin) ++num_contradicted;
    }
    return num_looked_at == 0
               ? 0.0
               : static_cast<double>(num_contradicted) / static_cast<double>(num_looked_at);
}

}  // namespace roomscribe
