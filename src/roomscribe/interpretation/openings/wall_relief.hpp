// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/interpretation/openings/face_axes.hpp"
#include "roomscribe/interpretation/rooms/wall_faces.hpp"
#include "roomscribe/interpretation/rooms/wall_rectangle.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// What was seen at a place of a wall's face: how many rays ended there or went on.
struct ReliefCell {
    std::uint32_t surface = 0;   ///< on the face
    std::uint32_t recess = 0;    ///< in the hole behind the face, as leaves, frames and panes lie
    std::uint32_t through = 0;   ///< farther behind it: the ray went through the wall
    std::uint32_t outdoors = 0;  ///< of `through`: below the floor, or far away
    std::uint32_t hidden = 0;    ///< before it: what lies behind was not seen
    std::uint32_t standing = 0;  ///< straight before it, no farther than furniture_depth

    std::uint32_t near = 0;  ///< close to the face, before or behind it (near_depth)
    float height = 0.0F;     ///< m, sum over `near` of how far before the face they lie

    std::uint32_t open() const { return recess + through; }
};

/// m behind the face. Leaves, panes and blinds lie no deeper in their wall; what does was seen
/// through it.
inline constexpr double max_wall_depth = 0.45;
/// m behind the face. Leaves lie to 12 cm deep (docs/interpretation.md); their noise.
inline constexpr double near_depth = 0.15;
/// m before the face. Shelves and wardrobes that stand at a wall are to 65 cm deep.
inline constexpr double furniture_depth = 0.65;
/// m before the face: a casing's 15 to 20 mm and the rebate's 15 mm on it (DIN 18101: 13 mm rebate,
/// and its gap), and noise. The doors of wardrobes stand farther.
inline constexpr double most_proud = 0.045;
inline constexpr int num_depth_bins = 36;
inline constexpr double depth_bin = max_wall_depth / num_depth_bins;

/// A wall's face in a raster: columns along the wall, rows upwards from the floor.
struct WallRelief {
    double cell_size = 0.0;
    double start = 0.0;      ///< m along the face's `along`, of the first column
    double bottom = 0.0;     ///< m along up, of the first row
    double tolerance = 0.0;  ///< m, of points that lie on the face
    int num_columns = 0;
    int num_rows = 0;
    std::vector<ReliefCell> cells;  ///< row by row
    /// How deep the points of `recess` lie: num_depth_bins counts per cell.
    std::vector<std::uint16_t> depths;
    /// The points within 10 cm before and behind the face: twice as far as doors step out of their
    /// wall or into it, so that what is uneven about the face does not end there.
    std::vector<FacePlace> near_points;
    /// Rays were followed: the scanners are known. Else what lies before or behind the face counts
    /// where it lies, and `through` is a guess: nothing was seen there at all.
    bool has_rays = false;
    /// What was seen through the wall is known from rays, or from inferred views; and of cells that
    /// none of these met, that nothing was seen there.
    bool looks_beyond = false;

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns) +
               static_cast<std::size_t>(column);
    }
    const ReliefCell& at(int column, int row) const { return cells[index(column, row)]; }
};

/// Follows the rays of every scanner before the face to where they meet its plane. Of very many
/// points an even share is looked at.
///
/// `bottom`, `top`: m along up, between which the wall stands.
WallRelief measure_wall_relief(const ScanMap& map, const WallFace& face, const Eigen::Vector3d& up,
                               double bottom, double top, double tolerance, double cell_size);

/// The relief's columns [first, first + count), without `near_points`.
WallRelief columns_of(const WallRelief& relief, int first, int count);

/// Share of the wall that something stands before for all scanners that looked there, in [0, 1];
/// casings and pictures, close to the wall, hide nothing. Empty where no rays were followed.
std::optional<double> hidden_share(const WallRelief& relief);

}  // namespace roomscribe
