// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// What a scanner knows of a place.
enum class Visibility : std::uint8_t {
    unseen,   ///< no ray went there
    free,     ///< rays passed through it: nothing was there
    surface,  ///< within the margin of the surface that the rays hit
    hidden    ///< behind that surface
};

/// The space that the rays of one scan crossed. Directions around the sensor are cut into the cells
/// of a cube map, which keep the nearest and the farthest return.
class FreeSpace {
  public:
    /// Cells are as fine as the points allow: `points_per_cell` in an occupied cell on the average,
    /// and no finer than the lines of the scanner, which would leave them apart. Points that are
    /// not finite are left out.
    FreeSpace(std::span<const Eigen::Vector3f> positions, const Eigen::Vector3d& sensor_position,
              double points_per_cell = 6.0);

    /// Judges a place in the scan's frame. `margin` (m) is how far off a surface still counts as on
    /// it. The neighbouring cells have their say, so that the rim of a surface, or a floor seen at
    /// a grazing angle, makes no space free that is not.
    Visibility look_at(const Eigen::Vector3d& place, double margin) const;

  private:
    struct Cell {
        float nearest = 0.0F;  ///< 0: no return
        float farthest = 0.0F;
    };
    struct CellPlace {
        int face;
        int row;
        int column;
    };
    /// What the cell and the up to eight around it hold.
    struct Neighborhood {
        int num_seen = 0;
        float nearest = 0.0F;
        float farthest = 0.0F;
    };
    CellPlace place_of(const Eigen::Vector3d& direction) const;
    std::size_t index_of(const CellPlace& place) const;
    Neighborhood look_around(const CellPlace& center) const;
    /// Of the occupied cells, those with so many occupied ones around that places there are judged.
    double share_of_touching_cells() const;
    /// Fills the cells; returns how many points an occupied one holds on the average.
    double fill(std::span<const Eigen::Vector3f> positions);
    friend double self_contradiction(std::span<const Eigen::Vector3f> positions,
                                     const Eigen::Vector3d& sensor_position, double margin);

    Eigen::Vector3d sensor_position_;
    int cells_per_edge_;
    std::vector<Cell> cells_;
};

/// Share of the points that stand clearly behind another point in the same narrow direction: below
/// a fifth for a scan that really was taken from the sensor position, a third and more for a cloud
/// that was merged from several places.
double self_contradiction(std::span<const Eigen::Vector3f> positions,
                          const Eigen::Vector3d& sensor_position, double margin);

}  // namespace roomscribe
