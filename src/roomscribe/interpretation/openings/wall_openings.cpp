// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/wall_openings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/openings/door_sides.hpp"
#include "roomscribe/interpretation/openings/flat_doors.hpp"
#include "roomscribe/interpretation/openings/mirror_test.hpp"
#include "roomscribe/interpretation/openings/opening_components.hpp"
#include "roomscribe/interpretation/openings/wall_holes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// m. Leaves have 0.61 to 1.11 m by 1.985 or 2.11 m (DIN 18101), double ones twice the width; old
// and narrow ones are a little off these.
constexpr double min_door_width = 0.55;
constexpr double max_door_width = 2.3;
constexpr double min_door_height = 1.8;
constexpr double max_door_height = 2.5;
constexpr double usual_door_height = 2.0;
/// m. Of a door as high as it was seen, where its lintel was not: a scanner whose rays rise by 15
/// degrees sees so high at 2 m.
constexpr double min_seen_door_height = 1.5;
constexpr double max_leaf_width = 1.3;
/// m. The widest single leaf of DIN 18101; the hole in its frame is no wider.
constexpr double widest_usual_leaf = 1.11;
/// m. Thresholds, skirtings and what lies on the floor.
constexpr double floor_reach = 0.25;
/// m. DIN 18040 allows thresholds of 2 cm; what is higher, in the plane of the wall, is a sill.
constexpr double thickest_threshold = 0.05;
/// m. Sills of windows are higher (0.8, in attics and old houses 0.6).
constexpr double unseen_reach = 0.6;
/// Of the rays that met a hole, those that end outdoors: fewer may be stray ones.
constexpr double min_outdoors = 0.02;
/// Confidence of a hole like a window's without a sign of glass, until drop_niches().
constexpr double unglazed = 0.1;
/// By how much more often than in the wall around it no ray comes back from a hole that is a
/// window for it alone: panes fill more than half of a French window. Dark or glancing leaves lose
/// some, too.
constexpr double pane_lost = 0.25;
/// m. Casings are no wider than two cells of this.
constexpr double flat_door_cell = 0.05;
/// m. Panes of doors: above a bottom rail, between stiles.
constexpr double max_rail = 0.35;
constexpr double min_glazing_height = 1.3;
constexpr double min_glazing_width = 0.3;  // each leaf of a narrow double door
constexpr double usual_rail = 0.12;
/// m. Outer walls are to 45 cm thick, with plaster and insulation to 60; inner ones 10 to 24.
constexpr double max_thickness = 0.6;
constexpr double usual_thickness = 0.12;
/// m. uPVC frame and sash together show 100 to 120 mm, fixed lights 50 to 70 mm.
constexpr double usual_window_frame = 0.08;

/// A window's pane lies in its frame, deeper than the frame's front.
void set_depths(WallOpening& opening, const HoleEvidence& evidence) {
    constexpr double usual_sinking = 0.035;
    constexpr double max_frame_depth = 0.3;
    const double sunk = evidence.sunk();
    double frame_depth = evidence.depths.rim.value_or(evidence.depth);
    // No frame lies behind its pane: of few points, most may have passed beside it.
    if (sunk < 0.0) frame_depth = std::min(frame_depth, evidence.depth);
    opening.frame_depth = std::min(frame_depth, max_frame_depth);
    opening.depth = opening.frame_depth + (sunk > 0.01 && sunk < 0.1 ? sunk : usual_sinking);
}

/// An upright patch: m along its own level direction and along up.
struct LeafExtent {
    Vector3d along = Vector3d::UnitX();
    double across = 0.0;  ///< m along its normal
    double start = 0.0;
    double end = 0.0;
    double bottom = 0.0;
    double top = 0.0;
};

/// What was found in one wall.
struct OpenedWall {
    std::vector<WallOpening> openings;
    std::optional<double> hidden;  ///< share of the wall
};

class OpeningFinder {
  public:
    OpeningFinder(const ScanMap& map, std::span<const Ray> rays, const SurfaceSample& sample,
                  std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                  const Eigen::Matrix3d& room_from_map, double point_spacing)
        : map_(map),
          sample_(sample),
          patches_(patches),
          surfaces_(surfaces),
          room_from_map_(room_from_map),
          up_(room_from_map.row(2).transpose()),
          // Two points to a cell and side, and no finer than frames are wide.
          cell_size_(std::clamp(2.0 * point_spacing, 0.04, 0.12)),
          mirror_test_(rays, sample) {
        for (const PlanarPatch& patch : patches_)
            extents_.push_back(is_upright(patch) ? extent_of(patch) : LeafExtent{});
    }

    OpenedWall look_at(std::size_t storey, std::size_t face) const;

  private:
    const StoreyLayout& layout(std::size_t storey) const { return surfaces_.storeys[storey]; }
    std::optional<WallOpening> judge(std::size_t storey, std::size_t face, const WallRelief& relief,
                                     const CellRectangle& hole) const;
    std::int32_t room_behind(const StoreyLayout& layout, const WallFace& face,
                             const WallRectangle& hole) const;
    bool is_indoors_behind(const StoreyLayout& layout, const WallFace& face,
                           const WallRectangle& hole) const;
    /// Leaves hang plumb.
    bool is_upright(const PlanarPatch& patch) const {
        return std::abs(patch.plane.normal.dot(up_)) <= std::sin(radians(8.0));
    }
    bool is_mirror(const WallFace& face, const WallRectangle& hole) const {
        constexpr double min_share = 0.5;
        return mirror_test_.share_of_images({face.plane, face.along, up_, hole}, max_wall_depth) >=
               min_share;
    }
    WallFace reach_to_corners(const StoreyLayout& rooms, const WallFace& face) const;
    LeafExtent extent_of(const PlanarPatch& patch) const;
    void widen_to_hinge(const WallFace& face, WallRectangle& hole) const;
    std::vector<OpenLeafSide> find_open_leaves(const WallFace& face, const WallRectangle& hole,
                                               double thickness) const;
    std::optional<double> thickness_at(const StoreyLayout& layout, const WallFace& face,
                                       const WallRectangle& hole) const;
    void add_flat_doors(std::size_t storey, std::size_t face, const WallRelief& relief,
                        std::vector<WallOpening>& openings) const;
    Vector3d place(const WallFace& face, double along, double up) const {
        return face.plane.offset * face.plane.normal + along * face.along + up * up_;
    }

    const ScanMap& map_;
    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    const RoomSurfaces& surfaces_;
    Eigen::Matrix3d room_from_map_;
    Vector3d up_;
    double cell_size_;
    MirrorTest mirror_test_;
    std::vector<LeafExtent> extents_;  ///< per patch; those of upright ones alone mean something
};

std::int32_t OpeningFinder::room_behind(const StoreyLayout& layout, const WallFace& face,
                                        const WallRectangle& hole) const {
    constexpr double farthest = 0.8;
    const Vector3d middle = place(face, 0.5 * (hole.start + hole.end), hole.bottom);
    for (double depth = 0.1; depth <= farthest; depth += 0.05) {
        const Vector3d point = room_from_map_ * (middle - depth * face.plane.normal);
        const std::int32_t room = layout.plan.room_at(point.head<2>());
        if (room != no_room && room != face.room) return room;
    }
    return no_room;
}

/// Whether floor or ceiling go on behind the hole.
bool OpeningFinder::is_indoors_behind(const StoreyLayout& layout, const WallFace& face,
                                      const WallRectangle& hole) const {
    const Vector2d backwards = -(room_from_map_ * face.plane.normal).head<2>();
    const auto is_indoors = [&](double share) {
        const Vector3d foot =
            room_from_map_ * place(face, hole.start + share * hole.width(), hole.bottom);
        return layout.plan.any_along(
            foot.head<2>(), backwards, 0.2, 1.5,
            [&](const Vector2d& behind) { return layout.plan.has_level_at(behind); });
    };
    return is_indoors(0.25) || is_indoors(0.5) || is_indoors(0.75);
}

/// m, to the face of the same wall in the room behind, where that was seen.
std::optional<double> OpeningFinder::thickness_at(const StoreyLayout& layout, const WallFace& face,
                                                  const WallRectangle& hole) const {
    std::optional<double> thickness;
    const Vector3d middle = place(face, 0.5 * (hole.start + hole.end), hole.bottom);
    for (const WallFace& other : layout.faces) {
        if (other.plane.normal.dot(face.plane.normal) > -std::cos(radians(15.0))) continue;
        const double depth = other.plane.signed_distance(middle);
        const double along = other.along.dot(middle);
        if (-depth < 0.03 || -depth > max_thickness) continue;
        if (along < other.start - hole.width() || along > other.end + hole.width()) continue;
        if (!thickness || -depth < *thickness) thickness = -depth;
    }
    return thickness;
}

LeafExtent OpeningFinder::extent_of(const PlanarPatch& patch) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    LeafExtent extent;
    extent.along = up_.cross(patch.plane.normal).normalized();
    extent.across = patch.plane.normal.dot(patch.centroid);
    extent.start = extent.bottom = infinity;
    extent.end = extent.top = -infinity;
    for (const std::uint32_t voxel : patch.points) {
        const Vector3d point = sample_.cloud.positions[voxel].cast<double>();
        extent.bottom = std::min(extent.bottom, point.dot(up_));
        extent.top = std::max(extent.top, point.dot(up_));
        extent.start = std::min(extent.start, point.dot(extent.along));
        extent.end = std::max(extent.end, point.dot(extent.along));
    }
    return extent;
}

/// What shows of leaves that stand open in a wall of a thickness, the one that fits the hole best
/// first: upright patches, as wide and high as the hole, with one upright edge at a side of it. The
/// lining of that side, as deep as the wall, may go on in the leaf's plane.
std::vector<OpenLeafSide> OpeningFinder::find_open_leaves(const WallFace& face,
                                                          const WallRectangle& hole,
                                                          double thickness) const {
    constexpr double max_hinge_gap = 0.25;
    constexpr double max_above = 0.2;  // m: casings are to 0.1 wide
    constexpr double edge_error = 0.05;
    std::vector<OpenLeafSide> sides;
    // Of two leaves each has half of the hole, and a part of a leaf may be hidden.
    const double widest = std::min(hole.width(), max_leaf_width);
    const double min_width = (hole.width() > widest_usual_leaf ? 0.4 : 0.6) * widest;
    const double max_width = hole.width() + 3.0 * edge_error;
    for (std::uint32_t number = 0; number < patches_.size(); ++number) {
        const PlanarPatch& patch = patches_[number];
        if (!is_upright(patch)) continue;
        const Vector3d middle = place(face, 0.5 * (hole.start + hole.end), patch.centroid.dot(up_));
        if ((patch.centroid - middle).norm() > hole.width() + 0.3) continue;
        // What lies across the hole in the depth of the wall, along its rims, would close it.
        constexpr double slack = 0.15;
        const double depth = -face.plane.signed_distance(patch.centroid);
        const double position = patch.centroid.dot(face.along);
        const bool is_across = position > hole.start && position < hole.end;
        if (std::abs(patch.plane.normal.dot(face.plane.normal)) > std::cos(radians(4.0)) &&
            depth > -slack && depth < (is_across ? thickness + slack : slack)) {
            continue;
        }
        const LeafExtent& extent = extents_[number];
        const double width = extent.end - extent.start;
        if (extent.top > hole.top + max_above || extent.top < hole.top - 0.4) continue;
        if (extent.top - extent.bottom < 0.5) continue;
        const auto in_plan = [&](double position) {
            const Vector3d edge = position * extent.along + extent.across * patch.plane.normal;
            return Vector2d(edge.dot(face.along), -face.plane.signed_distance(edge));
        };
        // One end of the leaf is at the hinge.
        double nearest = max_hinge_gap;
        std::optional<OpenLeafSide> leaf;
        for (const bool is_start : {true, false}) {
            const Vector2d edge = in_plan(is_start ? extent.start : extent.end);
            const Vector2d free_edge = in_plan(is_start ? extent.end : extent.start);
            for (const double side : {hole.start, hole.end}) {
                const double gap =
                    (edge - Vector2d(side, std::clamp(edge.y(), 0.0, thickness))).norm();
                // From the hinges where they belong, at the face that the leaf opens to.
                const Vector2d hinge(side, free_edge.y() < 0.5 * thickness ? 0.0 : thickness);
                const double reach = std::min((free_edge - hinge).norm(), width);
                if (gap > nearest || reach < min_width || reach > max_width) continue;
                nearest = gap;
                const double share = std::min(1.0, (hole.width() + edge_error) / width);
                leaf = {number, free_edge + share * (edge - free_edge), free_edge};
            }
        }
        if (leaf) sides.push_back(*leaf);
    }
    // Cupboards beside a door look like leaves.
    const auto misfit = [&](const OpenLeafSide& side) {
        return std::abs((side.free_edge - side.hinge).norm() - widest);
    };
    std::stable_sort(sides.begin(), sides.end(),
                     [&](const auto& a, const auto& b) { return misfit(a) < misfit(b); });
    return sides;
}

/// Whether leaves can close a hole: one that is as wide, or one at each side.
bool fill_hole(std::span<const OpenLeafSide> leaves, const WallRectangle& hole) {
    constexpr double min_share = 0.85;
    bool is_at_start = false;
    bool is_at_end = false;
    for (const OpenLeafSide& leaf : leaves) {
        if ((leaf.free_edge - leaf.hinge).norm() >= min_share * hole.width()) return true;
        const bool is_left = leaf.hinge.x() < 0.5 * (hole.start + hole.end);
        (is_left ? is_at_start : is_at_end) = true;
    }
    return hole.width() <= widest_usual_leaf ? !leaves.empty() : is_at_start && is_at_end;
}

std::optional<WallOpening> OpeningFinder::judge(std::size_t storey, std::size_t number,
                                                const WallRelief& relief,
                                                const CellRectangle& cells) const {
    const StoreyLayout& rooms = layout(storey);
    const WallFace& face = rooms.faces[number];
    WallOpening opening;
    opening.storey = storey;
    opening.face = number;
    opening.hole = measure_edges(relief, cells);
    WallRectangle& hole = opening.hole;
    const HoleEvidence evidence = look_into(relief, cells);
    opening.coverage = evidence.seen;
    opening.hidden = evidence.hidden;
    constexpr double min_seen = 0.4;
    // A part of a leaf, in one plane, says more than rays that passed.
    constexpr double min_seen_of_leaf = 0.2;
    constexpr double min_at_depth = 0.8;
    constexpr double min_lost = 0.08;
    constexpr double min_through = 0.1;
    const bool is_leaf_seen = evidence.opaque >= 0.6 && evidence.at_depth >= min_at_depth &&
                              evidence.seen >= min_seen_of_leaf;
    if (evidence.seen + evidence.lost < min_seen && !is_leaf_seen) return std::nullopt;
    const bool stands_on_floor = hole.bottom - rooms.floor_height <= max_rail;
    if (!is_framed_by_wall(evidence, stands_on_floor)) return std::nullopt;
    // Without rays a hole is told from wall that nobody looked at by its lining.
    constexpr double min_lining = 0.5;
    const bool is_guess = !relief.has_rays && evidence.through_share >= 0.5;
    if (is_guess && evidence.lining < min_lining) return std::nullopt;
    opening.room_behind = room_behind(rooms, face, hole);
    const double above_floor = hole.bottom - rooms.floor_height;
    // What was seen in the hole lies in one plane: a leaf, or the stiles and rails of a glazed one.
    constexpr double min_frame_share = 0.25;
    constexpr double min_sill = 0.9;
    const bool is_closed =
        (evidence.opaque >= 0.6 && evidence.at_depth >= 0.6) ||
        (evidence.opaque >= min_frame_share && evidence.at_depth >= min_at_depth);
    // Panes that show or swallow what is behind them.
    const bool shows_outdoors = evidence.outdoors >= 0.5;
    const bool is_pane = shows_outdoors || evidence.lost >= pane_lost;
    // Of a hole that begins so low: wall below it is a sill, or the bottom rail of a glazed leaf.
    // It is told from a leaf by lying clearly before what was seen in the hole.
    const bool has_sill =
        evidence.rim[static_cast<std::size_t>(HoleSide::bottom)].value_or(0.0) >= min_sill &&
        evidence.depth >= 2.0 * relief.tolerance;
    // Scanners whose rays fall by few degrees see nothing closely above the floor.
    const bool is_bottom_seen =
        evidence.rim[static_cast<std::size_t>(HoleSide::bottom)].has_value();
    const bool is_on_floor = has_sill         ? above_floor <= thickest_threshold
                             : is_bottom_seen ? above_floor <= floor_reach
                                              : above_floor <= unseen_reach && !is_pane;
    if (is_on_floor) {
        widen_to_hinge(face, hole);
        const double seen_height = hole.top - rooms.floor_height;
        const bool is_lintel_seen =
            evidence.rim[static_cast<std::size_t>(HoleSide::top)].has_value();
        if (!is_lintel_seen && !is_pane && seen_height >= min_seen_door_height)
            hole.top = std::max(hole.top, rooms.floor_height + usual_door_height);
    }
    const bool is_door_size = hole.width() >= min_door_width && hole.width() <= max_door_width &&
                              hole.top - rooms.floor_height >= min_door_height &&
                              hole.top - rooms.floor_height <= max_door_height;
    if (is_on_floor && is_door_size) {
        const bool is_indoors = opening.room_behind != no_room ||
                                (!shows_outdoors && is_indoors_behind(rooms, face, hole));
        hole.bottom = rooms.floor_height;
        opening.frame_width = casing_width;
        const bool is_glazed = evidence.lost >= min_lost ||
                               (relief.has_rays && evidence.through_share >= 0.3) ||
                               (shows_outdoors && evidence.opaque <= 1.0 - min_outdoors);
        if (is_closed && (is_indoors || !is_glazed || !is_pane)) {
            opening.rule = "leaf of a door's size in the wall, on the floor";
            opening.depth = evidence.depth;
            opening.confidence = 0.9;
            return opening;
        }
        // A door to a room that was not seen otherwise shows it.
        if (!is_indoors && is_glazed && is_pane) {
            opening.type = OpeningType::window;
            opening.rule = "glazed hole in the wall down to the floor, nothing indoors behind it";
            set_depths(opening, evidence);
            opening.frame_width = measure_frame(relief, cells).value_or(usual_window_frame);
            opening.confidence = 0.7;
            return opening;
        }
        const double thickness = thickness_at(rooms, face, hole).value_or(usual_thickness);
        opening.open_leaves = find_open_leaves(face, hole, thickness);
        if (!fill_hole(opening.open_leaves, hole)) opening.open_leaves.clear();
        opening.is_open = true;
        opening.depth = opening.open_leaves.empty()
                            ? 0.5 * thickness
                            : std::clamp(opening.open_leaves.front().hinge.y(), 0.0, thickness);
        opening.rule = "hole of a door's size in the wall and its open leaf";
        opening.confidence = 0.85;
        if (opening.open_leaves.empty()) {
            // Double doors are rarer than wide passages, and show a leaf more easily.
            const bool is_wide = hole.width() > widest_usual_leaf;
            opening.type = is_wide ? OpeningType::passage : OpeningType::door;
            opening.rule = is_wide ? "hole in the wall down to the floor, wider than a leaf"
                                   : "hole of a door's size in the wall, on the floor";
            opening.alternative =
                is_wide ? "double door whose leaves were not seen" : "passage without a leaf";
            opening.confidence = 0.6;
        }
        return opening;
    }
    if (above_floor <= max_rail && hole.height() >= min_glazing_height &&
        hole.width() >= min_glazing_width && hole.width() <= max_leaf_width && !shows_outdoors &&
        is_indoors_behind(rooms, face, hole)) {
        // The pane of a leaf whose rails lie in the plane of the wall.
        hole = hole.grown(usual_rail, 0.0, usual_rail);
        hole.bottom = rooms.floor_height;
        opening.frame_width = casing_width;
        opening.rule = "pane of a door's height in the wall, indoors behind it";
        opening.is_pane = true;
        opening.depth = 0.02;
        opening.confidence = 0.7;
        return opening;
    }
    if (hole.width() < min_window_side || hole.height() < min_window_side) return std::nullopt;
    if (above_floor < 0.3 && hole.height() < 1.5) return std::nullopt;
    // A part of a door.
    if (is_on_floor && !is_pane) return std::nullopt;
    // Panes let rays pass, or lose them, or lie deeper than the frame; the back of a niche does
    // none of these.
    // Where a niche's sides are seen aslant, they lie at all depths; a frame at one.
    constexpr double min_sinking = 0.02;
    constexpr double min_rim_at_depth = 0.25;
    const bool is_sunk =
        evidence.sunk() >= min_sinking && evidence.depths.rim_at_depth >= min_rim_at_depth;
    const bool is_glazed = evidence.lost >= min_lost || is_sunk || shows_outdoors || is_guess ||
                           (relief.has_rays && evidence.through_share >= min_through);
    // A mirror shows what lies behind it without a frame in the wall, and as often as not where
    // another room is; but never the ground outdoors, and nothing where no ray passes.
    constexpr double min_framed = 0.25;
    const bool may_be_mirror = !shows_outdoors && evidence.through_share >= min_through;
    if (!is_guess && !shows_outdoors && evidence.framed < min_framed) return std::nullopt;
    if ((is_guess || may_be_mirror) &&
        (is_indoors_behind(rooms, face, hole) || is_mirror(face, hole))) {
        return std::nullopt;
    }
    // A blind lies in one plane.
    if (!is_glazed && evidence.at_depth < 0.5) return std::nullopt;
    opening.type = OpeningType::window;
    set_depths(opening, evidence);
    opening.frame_width = measure_frame(relief, cells).value_or(usual_window_frame);
    opening.rule = is_glazed ? "glazed hole in the wall, above the floor"
                             : "hole in the wall like a window of the same storey";
    opening.confidence = is_glazed ? 0.85 : unglazed;
    return opening;
}

/// A leaf that stands ajar hides a part of its hole: that reaches to the hinge then.
void OpeningFinder::widen_to_hinge(const WallFace& face, WallRectangle& hole) const {
    if (hole.width() >= max_leaf_width || hole.height() < min_door_height - floor_reach) return;
    for (std::size_t number = 0; number < patches_.size(); ++number) {
        const PlanarPatch& patch = patches_[number];
        if (!is_upright(patch)) continue;
        if (std::abs(patch.plane.normal.dot(face.plane.normal)) > std::cos(radians(4.0))) continue;
        const LeafExtent& leaf = extents_[number];
        const double width = leaf.end - leaf.start;
        if (width < min_door_width || width > max_leaf_width) continue;
        // A scanner beside it does not see its top.
        if (leaf.top > hole.top + 0.15 || leaf.top < hole.top - 0.4) continue;
        if (leaf.top - leaf.bottom < 1.2) continue;
        for (const double end : {leaf.start, leaf.end}) {
            const Vector3d hinge = end * leaf.along + leaf.across * patch.plane.normal;
            if (std::abs(face.plane.signed_distance(hinge)) > 0.2) continue;
            const double position = hinge.dot(face.along);
            constexpr double slack = 0.15;
            if (position < hole.start && std::abs(hole.end - position - width) <= slack)
                hole.start = position;
            if (position > hole.end && std::abs(position - hole.start - width) <= slack)
                hole.end = position;
        }
    }
}

/// Closed leaves nearly in the plane of their wall: rectangles of a door's size, on the floor, that
/// lie a few millimetres deeper than the wall on both sides and above, or have a casing
/// around them that stands out.
void OpeningFinder::add_flat_doors(std::size_t storey, std::size_t number, const WallRelief& relief,
                                   std::vector<WallOpening>& openings) const {
    const StoreyLayout& rooms = layout(storey);
    for (const FlatDoor& door : find_flat_doors(relief)) {
        WallOpening opening;
        opening.storey = storey;
        opening.face = number;
        opening.hole = {relief.start + door.cells.left * relief.cell_size,
                        relief.start + door.cells.right * relief.cell_size, rooms.floor_height,
                        relief.bottom + door.cells.high * relief.cell_size};
        if (!door.has_lintel) opening.hole.top = rooms.floor_height + usual_door_height;
        const bool is_known =
            std::any_of(openings.begin(), openings.end(), [&](const WallOpening& known) {
                return std::min(opening.hole.end, known.hole.end) >
                       std::max(opening.hole.start, known.hole.start);
            });
        if (is_known) continue;
        opening.frame_width = casing_width;
        opening.depth = std::max(0.0, -door.height);
        opening.room_behind = room_behind(rooms, rooms.faces[number], opening.hole);
        opening.rule = "leaf of a door's size nearly in the plane of the wall, on the floor";
        opening.coverage = 1.0;
        opening.confidence = 0.75;
        openings.push_back(std::move(opening));
    }
}

/// The panes of a double door are side by side.
void join_panes(std::vector<WallOpening>& openings) {
    constexpr double slack = 0.1;
    const auto are_leaves = [](const WallOpening& a, const WallOpening& b) {
        return a.is_pane && b.is_pane && std::abs(a.hole.end - b.hole.start) <= slack &&
               std::abs(a.hole.top - b.hole.top) <= slack;
    };
    for (std::size_t i = 0; i < openings.size(); ++i) {
        const auto other = std::find_if(openings.begin(), openings.end(), [&](const auto& next) {
            return are_leaves(openings[i], next) &&
                   next.hole.end - openings[i].hole.start <= max_door_width;
        });
        if (other == openings.end()) continue;
        openings[i].hole.end = other->hole.end;
        openings[i].is_pane = false;
        const bool is_before = other - openings.begin() < static_cast<std::ptrdiff_t>(i);
        openings.erase(other);
        if (is_before) --i;
    }
}

/// The face up to the corners of its room: a door beside a corner leaves no wall there to be seen.
WallFace OpeningFinder::reach_to_corners(const StoreyLayout& rooms, const WallFace& face) const {
    constexpr double max_reach = 1.3;  // the widest usual leaf and its frame
    WallFace whole = face;
    for (const WallFace& other : rooms.faces) {
        if (other.room != face.room) continue;
        const double cosine = other.plane.normal.dot(face.along);
        if (std::abs(cosine) < std::cos(radians(45.0))) continue;
        const Vector3d foot = face.plane.offset * face.plane.normal;
        const double corner = (other.plane.offset - other.plane.normal.dot(foot)) / cosine;
        const Vector3d place = foot + corner * face.along;
        const double beyond =
            std::max(other.start - place.dot(other.along), place.dot(other.along) - other.end);
        if (beyond > max_reach) continue;
        // The room lies before the other face.
        if (cosine < 0.0 && corner > face.end && corner <= face.end + max_reach)
            whole.end = std::max(whole.end, corner);
        if (cosine > 0.0 && corner < face.start && corner >= face.start - max_reach)
            whole.start = std::min(whole.start, corner);
    }
    // In whole cells: the raster on what was seen of the face stays as it is.
    whole.start = face.start - cell_size_ * std::floor((face.start - whole.start) / cell_size_);
    return whole;
}

OpenedWall OpeningFinder::look_at(std::size_t storey, std::size_t number) const {
    const StoreyLayout& rooms = layout(storey);
    const WallFace& seen = rooms.faces[number];
    const WallFace face = reach_to_corners(rooms, seen);
    const auto& room = rooms.plan.rooms[static_cast<std::size_t>(face.room)];
    const double top = room.ceiling_height.value_or(face.top);
    const double tolerance = std::max(sample_.tolerance, 2.0 * face.rms);
    const WallRelief relief = measure_wall_relief(map_, face, up_, rooms.floor_height, top,
                                                  std::min(tolerance, 0.06), cell_size_);
    std::vector<WallOpening> openings;
    for (const CellRectangle& hole : find_wall_holes(relief)) {
        if (auto opening = judge(storey, number, relief, hole))
            openings.push_back(std::move(*opening));
    }
    join_panes(openings);
    const int first = static_cast<int>(std::lround((seen.start - face.start) / cell_size_));
    const int count = static_cast<int>(std::ceil(seen.width() / cell_size_));
    const WallRelief of_seen =
        columns_of(relief, first, std::min(count, relief.num_columns - first));
    if (cell_size_ <= flat_door_cell) {
        add_flat_doors(storey, number, of_seen, openings);
    } else {
        add_flat_doors(storey, number,
                       measure_wall_relief(map_, seen, up_, rooms.floor_height, top,
                                           std::min(tolerance, 0.06), flat_door_cell),
                       openings);
    }
    return {std::move(openings), hidden_share(of_seen)};
}

/// Of holes that may be windows behind blinds, or niches: only those are kept that look like a
/// window of the same building, since windows of a kind have one sill and one lintel.
void drop_niches(std::vector<WallOpening>& openings) {
    constexpr double alike = 0.1;
    const std::vector<WallOpening> all = openings;
    std::erase_if(openings, [&](const WallOpening& opening) {
        return opening.confidence <= unglazed &&
               std::none_of(all.begin(), all.end(), [&](const WallOpening& other) {
                   return other.type == OpeningType::window && other.storey == opening.storey &&
                          other.confidence > unglazed &&
                          std::abs(other.hole.bottom - opening.hole.bottom) <= alike &&
                          std::abs(other.hole.top - opening.hole.top) <= alike;
               });
    });
    for (WallOpening& opening : openings) {
        if (opening.confidence <= unglazed) opening.confidence = 0.7;
    }
}

/// Whether two openings are the two sides of one.
bool is_same(const WallOpening& a, const WallOpening& b, const RoomSurfaces& surfaces) {
    if (a.storey != b.storey || a.face == b.face) return false;
    const WallFace& face = surfaces.storeys[a.storey].faces[a.face];
    const WallFace& other = surfaces.storeys[b.storey].faces[b.face];
    if (std::abs(face.plane.normal.dot(other.plane.normal)) < std::cos(radians(15.0))) return false;
    const Vector3d middle =
        other.plane.offset * other.plane.normal + 0.5 * (b.hole.start + b.hole.end) * other.along;
    if (std::abs(face.plane.signed_distance(middle)) > max_thickness) return false;
    const double center = middle.dot(face.along);
    const double half = 0.5 * b.hole.width();
    const double overlap =
        std::min(center + half, a.hole.end) - std::max(center - half, a.hole.start);
    const double upright =
        std::min(a.hole.top, b.hole.top) - std::max(a.hole.bottom, b.hole.bottom);
    return overlap > 0.4 * std::min(a.hole.width(), b.hole.width()) &&
           upright > 0.4 * std::min(a.hole.height(), b.hole.height());
}

/// Which of two sides says more: a leaf that was seen, then the one that was seen better.
double merit(const WallOpening& opening) {
    return opening.confidence + 0.1 * opening.coverage;
}

}  // namespace

Openings find_openings(const ScanMap& map, std::span<const Ray> rays, const SurfaceSample& sample,
                       std::span<const PlanarPatch> patches, RoomSurfaces& surfaces,
                       const Eigen::Matrix3d& room_from_map, double point_spacing,
                       const Context& context) {
    const OpeningFinder finder(map, rays, sample, patches, surfaces, room_from_map, point_spacing);
    std::vector<std::pair<std::size_t, std::size_t>> jobs;
    for (std::size_t storey = 0; storey < surfaces.storeys.size(); ++storey) {
        for (std::size_t face = 0; face < surfaces.storeys[storey].faces.size(); ++face)
            jobs.emplace_back(storey, face);
    }
    std::vector<OpenedWall> found(jobs.size());
    parallel_for(context, jobs.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            found[i] = finder.look_at(jobs[i].first, jobs[i].second);
    });
    std::vector<WallOpening> sides;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const auto [storey, face] = jobs[i];
        const std::size_t wall = surfaces.storeys[storey].wall_of_face[face];
        surfaces.surfaces[wall].component.evidence.occluded = found[i].hidden;
        std::move(found[i].openings.begin(), found[i].openings.end(), std::back_inserter(sides));
    }
    std::stable_sort(sides.begin(), sides.end(), [](const WallOpening& a, const WallOpening& b) {
        return merit(a) > merit(b);
    });
    drop_niches(sides);
    Openings result;
    for (WallOpening& side : sides) {
        const bool is_known =
            std::any_of(result.openings.begin(), result.openings.end(),
                        [&](const WallOpening& known) { return is_same(known, side, surfaces); });
        if (!is_known) result.openings.push_back(std::move(side));
    }
    fit_door_sides(map.cloud, sample, surfaces, room_from_map.row(2).transpose(), result.openings,
                   context);
    result.components =
        make_opening_components(result.openings, surfaces, room_from_map.row(2).transpose());
    return result;
}

}  // namespace roomscribe
