// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"
#include "roomscribe/interpretation/rooms/wall_rectangle.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// The upright side of a piece that is turned to the room, in the map frame.
struct FrontSide {
    std::size_t piece = 0;              ///< number that the caller gave
    Plane plane;                        ///< upright; the normal looks off the piece
    Eigen::Vector3d along;              ///< level, within the plane: up x normal
    std::vector<std::uint32_t> voxels;  ///< of the sample, on it or a front's thickness behind
};

/// A door, a drawer front, or several that no gap was seen between.
struct FrontPanel {
    std::size_t side = 0;   ///< of the front sides
    WallRectangle extent;   ///< m along `along` and along up
    double rms = 0.0;       ///< m, of the side's points about its plane
    std::string_view kind;  ///< "door", "drawer", or "front" for what may be several
    bool may_be_several = false;
};

/// What a panel of this size is.
struct PanelKind {
    std::string_view name;  ///< "door", "drawer", or "front" for what may be several
    bool may_be_several = false;
};
/// `is_whole`: the front of a piece that nothing parted.
PanelKind kind_of_panel(const WallRectangle& extent, bool is_whole);

/// The front of a piece that has_fronts: the largest upright patch among those that look away from
/// the wall that it stands at (of a free-standing one, any). Nothing if there is none.
std::optional<FrontSide> find_front_side(const FurnitureVoxels& all, const PieceDraft& draft,
                                         const PieceForm& form,
                                         std::span<const PlanarPatch> patches,
                                         const Eigen::Matrix3d& room_from_map,
                                         const Eigen::Vector3d& to_room);

/// Whether a side closes the piece below its top, as fronts do: over half of its length it was seen
/// 0.2 m high and more, wherever, for what is seen from above ends half-way down. The aprons of
/// tables are 0.08 to 0.12 m high, and legs are few.
bool closes_piece(const FurnitureVoxels& all, const PieceDraft& draft, const PieceForm& form,
                  const FrontSide& side, const Eigen::Matrix3d& room_from_map);

/// The panels of each front side. Its extent is that of the map's points that lie on it. Where
/// points lie a few millimetres to centimetres deeper along a straight line from edge to edge, it
/// is parted there: rays enter the gaps of 3 to 5 mm between fronts. One line after another, the
/// clearest first; none where noise reaches as deep as doors are thick. `up` is a unit vector in
/// the map frame.
std::vector<FrontPanel> find_front_panels(const PointCloud& map, const SurfaceSample& sample,
                                          std::span<const FrontSide> sides,
                                          const Eigen::Vector3d& up);

}  // namespace roomscribe
