// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/interpretation/openings/open_leaves.hpp"
#include "roomscribe/interpretation/openings/wall_relief.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// m. Architraves are 44 to 95 mm wide.
inline constexpr double casing_width = 0.06;

enum class OpeningType : std::uint8_t {
    door,
    window,
    passage,  ///< a way without a leaf: a component of kind `opening`
};

/// A hole in a wall, and what fills it.
struct WallOpening {
    OpeningType type = OpeningType::door;
    std::size_t face = 0;      ///< of the storey's faces, or its slopes
    std::size_t storey = 0;    ///< of RoomSurfaces::storeys
    bool is_in_roof = false;   ///< in a slope
    WallRectangle hole;        ///< a door's leaf, or a window's hole
    double depth = 0.0;        ///< m behind the face, of leaf or pane; < 0: before it
    double frame_depth = 0.0;  ///< m behind the face, of a window's frame and mullions
    double frame_width = 0.0;  ///< m; around a leaf, within a window's hole; 0 for none
    bool has_casing = false;   ///< a door's or a passage's, that was seen to step out of the wall
    bool is_open = false;      ///< a door that stands open
    bool is_pane = false;      ///< a door of which one pane was told
    std::vector<OpenLeafSide> open_leaves;  ///< of an open door
    std::int32_t room_behind = no_room;
    double coverage = 0.0;  ///< share of the hole that was seen into
    double hidden = 0.0;    ///< share that something stands before
    double confidence = 0.0;
    std::string_view rule;         ///< that it was told by, in words
    std::string_view alternative;  ///< the rival reading; not empty if doubtful
    /// Numbers of its components in Openings::components: door, window or passage, then the frame,
    /// if it has one.
    std::vector<std::size_t> components;
};

/// The face of a wall, or the slope of a roof, that an opening is set in.
inline const WallFace& face_of(const WallOpening& opening, const RoomSurfaces& surfaces) {
    const StoreyLayout& layout = surfaces.storeys[opening.storey];
    return opening.is_in_roof ? layout.slopes[opening.face] : layout.faces[opening.face];
}

struct Openings {
    std::vector<WallOpening> openings;
    std::vector<Component> components;
};

/// Doors and windows with their frames, by the paper's rules of size and place (its Table
/// 3: a door on the edge of a wall and close to the floor, a window embedded in the wall and higher
/// up) and beyond it.
///
/// Each wall's face is looked at cell by cell (measure_wall_relief). A hole (find_wall_holes) at
/// the floor as high as a door is a door, closed where a leaf, or the stiles and rails of a glazed
/// one, fill it. Where no leaf was seen that could close it, it is a passage if wider than any
/// single leaf, and a doubtful door if not. Wall below a hole is a sill. A hole above the floor
/// that shows signs of glass, or is like one that does, is a window, but for mirrors, which `rays`
/// tell (MirrorTest). Closed leaves nearly in the plane of their wall are found by find_flat_doors.
/// What opens to both sides of a wall is one opening. A roof's slopes are looked at for windows
/// alone. Instances are counted on from `surfaces`, whose rooms learn their neighbours and whose
/// walls learn how much of them is hidden.
Openings find_openings(const ScanMap& map, std::span<const Ray> rays, const SurfaceSample& sample,
                       std::span<const PlanarPatch> patches, RoomSurfaces& surfaces,
                       const Eigen::Matrix3d& room_from_map, double point_spacing,
                       const Context& context = {});

}  // namespace roomscribe
