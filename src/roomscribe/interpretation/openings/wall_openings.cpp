// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/wall_openings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/openings/door_outlines.hpp"
#include "roomscribe/interpretation/openings/door_sides.hpp"
#include "roomscribe/interpretation/openings/door_sizes.hpp"
#include "roomscribe/interpretation/openings/flat_doors.hpp"
#include "roomscribe/interpretation/openings/mirror_test.hpp"
#include "roomscribe/interpretation/openings/open_leaves.hpp"
#include "roomscribe/interpretation/openings/opening_components.hpp"
#include "roomscribe/interpretation/openings/wall_holes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// m. Of a door as high as it was seen, where its lintel was not: a scanner whose rays rise by 15
/// degrees sees so high at 2 m.
constexpr double min_seen_door_height = 1.5;
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
/// m, of points on a wall's face: frames and leaves lie deeper.
constexpr double max_tolerance = 0.06;
/// m. Casings are no wider than two cells of this.
constexpr double flat_door_cell = 0.05;
/// Shares of a hole: of rays that never came back, and of those that passed, which glass needs.
constexpr double min_lost = 0.08;
constexpr double min_through = 0.1;
/// Share of a hole in which something was seen, and of that which lies at one depth, of leaves.
constexpr double min_leaf_share = 0.6;
constexpr double min_at_depth = 0.8;
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

/// One of which no more is known than where it is looked for.
WallOpening opening_in(std::size_t storey, std::size_t face, bool is_in_roof = false) {
    WallOpening opening;
    opening.storey = storey;
    opening.face = face;
    opening.is_in_roof = is_in_roof;
    return opening;
}

/// A window's pane lies in its frame, deeper than the frame's front.
void set_depths(WallOpening& opening, const HoleEvidence& evidence) {
    constexpr double usual_sinking = 0.035;
    const double sunk = evidence.sunk();
    opening.frame_depth = evidence.frame_depth();
    opening.depth =
        opening.frame_depth + (sunk > 0.01 && sunk < most_sinking ? sunk : usual_sinking);
}

/// Whether enough was seen of a hole to say what it is.
bool is_seen_enough(const HoleEvidence& evidence) {
    constexpr double min_seen = 0.4;
    // A part of a leaf, in one plane, says more than rays that passed.
    constexpr double min_seen_of_leaf = 0.2;
    const bool is_leaf_seen = evidence.opaque >= min_leaf_share &&
                              evidence.at_depth >= min_at_depth &&
                              evidence.seen >= min_seen_of_leaf;
    return evidence.seen + evidence.lost >= min_seen || is_leaf_seen;
}

/// What the evidence says of a hole, before it is known what it is.
struct HoleSigns {
    double above_floor = 0.0;     ///< m
    bool is_guess = false;        ///< nobody knows whether rays passed
    bool is_closed = false;       ///< by a leaf, or the stiles and rails of a glazed one
    bool shows_outdoors = false;  ///< most of the rays that met it end there
    bool is_pane = false;         ///< it shows or swallows what is behind it
    bool is_on_floor = false;
};

HoleSigns read_signs(const HoleEvidence& evidence, const WallRelief& relief, double above_floor) {
    HoleSigns signs;
    signs.above_floor = above_floor;
    signs.is_guess = !relief.looks_beyond && evidence.through_share >= 0.5;
    // What was seen in the hole lies in one plane.
    constexpr double min_frame_share = 0.25;
    signs.is_closed = (evidence.opaque >= min_leaf_share && evidence.at_depth >= 0.6) ||
                      (evidence.opaque >= min_frame_share && evidence.at_depth >= min_at_depth);
    signs.shows_outdoors = evidence.outdoors >= 0.5;
    signs.is_pane = signs.shows_outdoors || evidence.lost >= pane_lost;
    // Of a hole that begins so low: wall below it is a sill, or the bottom rail of a glazed leaf.
    // It is told from a leaf by lying clearly before what was seen in the hole.
    constexpr double min_sill = 0.9;
    const bool has_sill = evidence.rim_of(HoleSide::bottom).value_or(0.0) >= min_sill &&
                          evidence.depth >= 2.0 * relief.tolerance;
    // Scanners whose rays fall by few degrees see nothing closely above the floor.
    if (has_sill)
        signs.is_on_floor = above_floor <= thickest_threshold;
    else if (evidence.rim_of(HoleSide::bottom))
        signs.is_on_floor = above_floor <= floor_reach;
    else
        signs.is_on_floor = above_floor <= unseen_reach && !signs.is_pane;
    return signs;
}

bool is_of_door_size(double width, double height) {
    return width >= min_door_width && width <= max_door_width && height >= min_door_height &&
           height <= max_door_height;
}

/// The pane of a leaf whose rails lie in the plane of the wall.
void make_glazed_door(double floor_height, WallOpening& opening) {
    opening.hole = opening.hole.grown(usual_rail, 0.0, usual_rail);
    opening.hole.bottom = floor_height;
    opening.frame_width = casing_width;
    opening.rule = "pane of a door's height between rails in the plane of the wall";
    opening.is_pane = true;
    opening.depth = 0.02;
    opening.confidence = 0.7;
}

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
          surfaces_(surfaces),
          room_from_map_(room_from_map),
          up_(room_from_map.row(2).transpose()),
          // Two points to a cell and side, and no finer than frames are wide.
          cell_size_(std::clamp(2.0 * point_spacing, 0.04, 0.12)),
          mirror_test_(rays, sample),
          leaves_(sample, patches, up_) {}

    OpenedWall look_at(std::size_t storey, std::size_t face) const;
    OpenedWall look_at_slope(std::size_t storey, std::size_t slope) const;

  private:
    const StoreyLayout& layout(std::size_t storey) const { return surfaces_.storeys[storey]; }
    std::vector<WallOpening> judge_holes(const WallOpening& place, const WallRelief& relief) const;
    std::optional<WallOpening> judge(WallOpening opening, const WallRelief& relief,
                                     const CellRectangle& cells) const;
    void judge_way(const HoleEvidence& evidence, const HoleSigns& signs, const WallRelief& relief,
                   const CellRectangle& cells, WallOpening& opening) const;
    void judge_open_way(WallOpening& opening) const;
    bool judge_window(const HoleEvidence& evidence, const HoleSigns& signs,
                      const WallRelief& relief, const CellRectangle& cells,
                      WallOpening& opening) const;
    std::int32_t room_behind(const StoreyLayout& layout, const WallFace& face,
                             const WallRectangle& hole) const;
    bool is_indoors_behind(const StoreyLayout& layout, const WallFace& face,
                           const WallRectangle& hole) const;
    bool is_mirror(const WallFace& face, const WallRectangle& hole) const {
        constexpr double min_share = 0.5;
        return mirror_test_.share_of_images({face.plane, face.along, face.up, hole},
                                            max_wall_depth) >= min_share;
    }
    WallFace reach_to_corners(const StoreyLayout& rooms, const WallFace& face) const;
    std::optional<double> thickness_at(const StoreyLayout& layout, const WallFace& face,
                                       const WallRectangle& hole) const;
    void add_outlined_doors(const WallOpening& place, const WallRelief& relief,
                            std::vector<WallOpening>& openings) const;
    void add_flat_doors(std::size_t storey, std::size_t face, const WallRelief& relief,
                        std::vector<WallOpening>& openings) const;
    Vector3d place(const WallFace& face, double along, double up) const {
        return face.plane.offset * face.plane.normal + along * face.along + up * face.up;
    }

    const ScanMap& map_;
    const SurfaceSample& sample_;
    const RoomSurfaces& surfaces_;
    Eigen::Matrix3d room_from_map_;
    Vector3d up_;
    double cell_size_;
    MirrorTest mirror_test_;
    OpenLeafFinder leaves_;
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

/// What fills a hole of a door's size on the floor.
void OpeningFinder::judge_way(const HoleEvidence& evidence, const HoleSigns& signs,
                              const WallRelief& relief, const CellRectangle& cells,
                              WallOpening& opening) const {
    const StoreyLayout& rooms = layout(opening.storey);
    const bool is_indoors = opening.room_behind != no_room ||
                            (!signs.shows_outdoors &&
                             is_indoors_behind(rooms, rooms.faces[opening.face], opening.hole));
    opening.hole.bottom = rooms.floor_height;
    opening.frame_width = casing_width;
    const bool is_glazed = evidence.lost >= min_lost ||
                           (relief.looks_beyond && evidence.through_share >= 0.3) ||
                           (signs.shows_outdoors && evidence.opaque <= 1.0 - min_outdoors);
    // Of a leaf deep in its wall, seen aslant, most rays show the reveals.
    const std::optional<double> leaf_depth =
        leaves_.closed_leaf_depth(rooms.faces[opening.face], opening.hole);
    if ((leaf_depth || signs.is_closed) && (is_indoors || !is_glazed || !signs.is_pane)) {
        opening.rule = "leaf of a door's size in the wall, on the floor";
        opening.depth = leaf_depth.value_or(evidence.depth);
        opening.confidence = 0.9;
    } else if (!is_indoors && is_glazed && signs.is_pane) {
        // A door to a room that was not seen otherwise shows it.
        opening.type = OpeningType::window;
        opening.rule = "glazed hole in the wall down to the floor, nothing indoors behind it";
        set_depths(opening, evidence);
        opening.frame_width = measure_frame(relief, cells).value_or(usual_window_frame);
        opening.confidence = 0.7;
    } else {
        judge_open_way(opening);
    }
}

/// A door whose leaf stands open, or a way without one.
void OpeningFinder::judge_open_way(WallOpening& opening) const {
    const StoreyLayout& rooms = layout(opening.storey);
    const WallFace& face = rooms.faces[opening.face];
    std::optional<double> known = thickness_at(rooms, face, opening.hole);
    if (!known) known = leaves_.lining_depth(face, opening.hole, max_thickness);
    const double thickness = known.value_or(usual_thickness);
    opening.open_leaves = leaves_.find(face, opening.hole, thickness);
    if (!can_close(opening.open_leaves, opening.hole)) opening.open_leaves.clear();
    opening.is_open = true;
    if (!opening.open_leaves.empty()) {
        opening.depth = std::clamp(opening.open_leaves.front().hinge.y(), 0.0, thickness);
        opening.rule = "hole of a door's size in the wall and its open leaf";
        opening.confidence = 0.85;
        return;
    }
    opening.depth = 0.5 * thickness;
    opening.confidence = 0.6;
    const double height = opening.hole.top - rooms.floor_height;
    if (opening.hole.width() > widest_usual_leaf) {
        // Double doors are rarer than wide passages, and show a leaf more easily.
        opening.type = OpeningType::passage;
        opening.rule = "hole in the wall down to the floor, wider than a leaf";
        opening.alternative = "double door whose leaves were not seen";
    } else if (height > tallest_usual_leaf + cell_size_) {
        opening.type = OpeningType::passage;
        opening.rule = "hole in the wall down to the floor, higher than a leaf";
        opening.alternative = "door whose leaf was not seen";
    } else {
        opening.type = OpeningType::door;
        opening.rule = "hole of a door's size in the wall, on the floor";
        opening.alternative = "passage without a leaf";
    }
}

/// Whether a hole above the floor, or a glazed one, is a window.
bool OpeningFinder::judge_window(const HoleEvidence& evidence, const HoleSigns& signs,
                                 const WallRelief& relief, const CellRectangle& cells,
                                 WallOpening& opening) const {
    const WallRectangle& hole = opening.hole;
    if (hole.width() < min_window_side || hole.height() < min_window_side) return false;
    if (signs.above_floor < 0.3 && hole.height() < 1.5) return false;
    // A part of a door.
    if (signs.is_on_floor && !signs.is_pane) return false;
    // Panes let rays pass, or lose them, or lie deeper than the frame; the back of a niche does
    // none of these. Where a niche's sides are seen aslant, they lie at all depths; a frame at one.
    constexpr double min_sinking = 0.02;
    constexpr double min_rim_at_depth = 0.25;
    const bool is_sunk =
        evidence.sunk() >= min_sinking && evidence.depths.rim_at_depth >= min_rim_at_depth;
    // Panes return few rays; half of a window may be blinds.
    constexpr double max_thinned = 0.7;
    const bool is_glazed = evidence.lost >= min_lost || is_sunk || signs.shows_outdoors ||
                           signs.is_guess || evidence.thinned <= max_thinned ||
                           (relief.looks_beyond && evidence.through_share >= min_through);
    // A mirror shows what lies behind it without a frame in the wall, and as often as not where
    // another room is; but never the ground outdoors, and nothing where no ray passes.
    const bool may_be_mirror = !signs.shows_outdoors && evidence.through_share >= min_through;
    if (!signs.is_guess && !signs.shows_outdoors && evidence.framed < min_framed) return false;
    const StoreyLayout& rooms = layout(opening.storey);
    const WallFace& face = face_of(opening, surfaces_);
    if (!opening.is_in_roof && (signs.is_guess || may_be_mirror) &&
        (is_indoors_behind(rooms, face, hole) || is_mirror(face, hole))) {
        return false;
    }
    // A blind lies in one plane.
    if (!is_glazed && evidence.at_depth < 0.5) return false;
    opening.type = OpeningType::window;
    opening.hole.top += relief.cell_size * (top_of_blind(relief, cells) - cells.high);
    set_depths(opening, evidence);
    opening.frame_width = measure_frame(relief, cells).value_or(usual_window_frame);
    opening.rule = opening.is_in_roof ? "glazed hole in the slope of a roof"
                   : is_glazed        ? "glazed hole in the wall, above the floor"
                                      : "hole in the wall like a window of the same storey";
    opening.confidence = is_glazed ? 0.85 : unglazed;
    return true;
}

/// `opening` says in which face.
std::optional<WallOpening> OpeningFinder::judge(WallOpening opening, const WallRelief& relief,
                                                const CellRectangle& cells) const {
    const StoreyLayout& rooms = layout(opening.storey);
    const WallFace& face = face_of(opening, surfaces_);
    const HoleEvidence evidence = look_into(relief, cells);
    if (!is_seen_enough(evidence)) return std::nullopt;
    opening.hole = measure_edges(relief, cells);
    opening.coverage = evidence.seen;
    opening.hidden = evidence.hidden;
    WallRectangle& hole = opening.hole;
    const double bottom =
        opening.is_in_roof ? up_.dot(place(face, hole.start, hole.bottom)) : hole.bottom;
    const HoleSigns signs = read_signs(evidence, relief, bottom - rooms.floor_height);
    if (!is_framed_by_wall(evidence, signs.above_floor <= max_rail)) return std::nullopt;
    // Without rays a hole is told from wall that nobody looked at by its lining.
    constexpr double min_lining = 0.5;
    if (signs.is_guess && evidence.lining < min_lining) return std::nullopt;
    if (opening.is_in_roof) {
        if (!judge_window(evidence, signs, relief, cells, opening)) return std::nullopt;
        return opening;
    }
    opening.room_behind = room_behind(rooms, face, hole);
    if (signs.is_on_floor) {
        leaves_.widen_to_hinge(face, hole);
        if (!evidence.rim_of(HoleSide::top) && !signs.is_pane &&
            hole.top - rooms.floor_height >= min_seen_door_height)
            hole.top = std::max(hole.top, rooms.floor_height + usual_door_height);
        if (is_of_door_size(hole.width(), hole.top - rooms.floor_height)) {
            judge_way(evidence, signs, relief, cells, opening);
            return opening;
        }
    }
    if (signs.above_floor <= max_rail && hole.height() >= min_glazing_height &&
        hole.top + usual_rail <= rooms.floor_height + max_door_height &&
        hole.width() >= min_glazing_width && hole.width() <= max_leaf_width &&
        (opening.room_behind != no_room ||
         (!signs.shows_outdoors && is_indoors_behind(rooms, face, hole)) ||
         (is_flush_pane(evidence) && !is_mirror(face, hole)))) {
        make_glazed_door(rooms.floor_height, opening);
        return opening;
    }
    if (!judge_window(evidence, signs, relief, cells, opening)) return std::nullopt;
    return opening;
}

/// Share of the cells within the rectangle straight before which more was seen than on them: the
/// boards of shelves and what hangs in wardrobes stand before their backs.
double covered_share(const WallRelief& relief, const WallRectangle& area) {
    double met = 0.0;
    double covered = 0.0;
    for (int row = 0; row < relief.num_rows; ++row) {
        for (int column = 0; column < relief.num_columns; ++column) {
            const double along = relief.start + (column + 0.5) * relief.cell_size;
            const double above = relief.bottom + (row + 0.5) * relief.cell_size;
            const ReliefCell& cell = relief.at(column, row);
            if (along < area.start || along > area.end || above > area.top || cell.near == 0)
                continue;
            ++met;
            covered += cell.standing > cell.near ? 1.0 : 0.0;
        }
    }
    return covered / std::max(met, 1.0);
}

/// Doors told by a border that steps out of the wall, or into it. What was found in the leaf, above
/// its bottom rail, is its panes; other openings of the same place say more than a border does.
void OpeningFinder::add_outlined_doors(const WallOpening& place, const WallRelief& relief,
                                       std::vector<WallOpening>& openings) const {
    constexpr double slack = 0.05;
    constexpr double min_rail = 0.1;
    // m; niches for radiators, below and around a window, are deeper.
    constexpr double most_sunk_with_panes = 0.03;
    const StoreyLayout& rooms = layout(place.storey);
    const WallFace& seen = rooms.faces[place.face];
    const WallRectangle wall{seen.start, seen.end, relief.bottom,
                             relief.bottom + relief.num_rows * relief.cell_size};
    for (const DoorOutline& outline : find_door_outlines(relief.near_points, wall)) {
        const WallRectangle& border = outline.border;
        const auto is_beside = [&](const WallOpening& known) {
            return known.hole.end <= border.start || known.hole.start >= border.end;
        };
        const auto is_pane = [&](const WallOpening& known) {
            return known.is_pane ||
                   (known.type == OpeningType::window && outline.step >= -most_sunk_with_panes &&
                    known.hole.start >= border.start - slack &&
                    known.hole.end <= border.end + slack &&
                    known.hole.bottom >= border.bottom + min_rail &&
                    known.hole.top <= border.top + slack);
        };
        const bool is_free = std::all_of(
            openings.begin(), openings.end(),
            [&](const WallOpening& known) { return is_beside(known) || is_pane(known); });
        if (!is_free || covered_share(relief, border) > max_covered) continue;
        std::erase_if(openings, [&](const WallOpening& known) {
            return !is_beside(known) && is_pane(known);
        });
        WallOpening opening = place;
        // The border of what stands out is that of the casing.
        const double casing = outline.step > 0.0 ? casing_width : 0.0;
        opening.hole = border.grown(-casing, 0.0, -casing);
        opening.frame_width = casing_width;
        opening.depth = -outline.inside;
        opening.room_behind = room_behind(rooms, seen, opening.hole);
        opening.rule = "outline of a door's size that steps out of its wall, on the floor";
        opening.coverage = 1.0;
        opening.confidence = 0.8;
        openings.push_back(std::move(opening));
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
        opening.depth = -door.height;
        opening.room_behind = room_behind(rooms, rooms.faces[number], opening.hole);
        opening.rule = "leaf of a door's size nearly in the plane of the wall, on the floor";
        opening.coverage = 1.0;
        opening.confidence = 0.75;
        openings.push_back(std::move(opening));
    }
}

/// The panes of a double door are side by side. Of one the top may not have been seen.
void join_panes(std::vector<WallOpening>& openings) {
    constexpr double slack = 0.1;
    const auto are_leaves = [](const WallOpening& a, const WallOpening& b) {
        return a.is_pane && b.is_pane && std::abs(a.hole.end - b.hole.start) <= slack;
    };
    for (std::size_t i = 0; i < openings.size(); ++i) {
        const auto other = std::find_if(openings.begin(), openings.end(), [&](const auto& next) {
            return are_leaves(openings[i], next) &&
                   next.hole.end - openings[i].hole.start <= max_door_width;
        });
        if (other == openings.end()) continue;
        openings[i].hole.end = other->hole.end;
        openings[i].hole.top = std::max(openings[i].hole.top, other->hole.top);
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

std::vector<WallOpening> OpeningFinder::judge_holes(const WallOpening& place,
                                                    const WallRelief& relief) const {
    std::vector<WallOpening> openings;
    for (const CellRectangle& hole : find_wall_holes(relief)) {
        if (auto opening = judge(place, relief, hole)) openings.push_back(std::move(*opening));
    }
    return openings;
}

OpenedWall OpeningFinder::look_at_slope(std::size_t storey, std::size_t number) const {
    const WallFace& face = layout(storey).slopes[number];
    const double tolerance = std::max(sample_.tolerance, 2.0 * face.rms);
    const WallRelief relief = measure_wall_relief(map_, face, face.up, face.bottom, face.top,
                                                  std::min(tolerance, max_tolerance), cell_size_);
    return {judge_holes(opening_in(storey, number, true), relief), {}};
}

OpenedWall OpeningFinder::look_at(std::size_t storey, std::size_t number) const {
    const StoreyLayout& rooms = layout(storey);
    const WallFace& seen = rooms.faces[number];
    const WallFace face = reach_to_corners(rooms, seen);
    const auto& room = rooms.plan.rooms[static_cast<std::size_t>(face.room)];
    const double top = room.ceiling_height.value_or(face.top);
    const double tolerance = std::max(sample_.tolerance, 2.0 * face.rms);
    const WallRelief relief = measure_wall_relief(map_, face, up_, rooms.floor_height, top,
                                                  std::min(tolerance, max_tolerance), cell_size_);
    std::vector<WallOpening> openings = judge_holes(opening_in(storey, number), relief);
    join_panes(openings);
    add_outlined_doors(opening_in(storey, number), relief, openings);
    const int first = static_cast<int>(std::lround((seen.start - face.start) / cell_size_));
    const int count = static_cast<int>(std::ceil(seen.width() / cell_size_));
    const WallRelief of_seen =
        columns_of(relief, first, std::min(count, relief.num_columns - first));
    if (cell_size_ <= flat_door_cell) {
        add_flat_doors(storey, number, of_seen, openings);
    } else {
        add_flat_doors(storey, number,
                       measure_wall_relief(map_, seen, up_, rooms.floor_height, top,
                                           std::min(tolerance, max_tolerance), flat_door_cell),
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
                          other.is_in_roof == opening.is_in_roof && other.confidence > unglazed &&
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
    if (a.storey != b.storey) return false;
    const WallFace& face = face_of(a, surfaces);
    const WallFace& other = face_of(b, surfaces);
    if (&face == &other) return false;
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
    std::vector<WallOpening> jobs;
    for (std::size_t storey = 0; storey < surfaces.storeys.size(); ++storey) {
        for (std::size_t face = 0; face < surfaces.storeys[storey].faces.size(); ++face)
            jobs.push_back(opening_in(storey, face));
        for (std::size_t slope = 0; slope < surfaces.storeys[storey].slopes.size(); ++slope)
            jobs.push_back(opening_in(storey, slope, true));
    }
    std::vector<OpenedWall> found(jobs.size());
    parallel_for(context, jobs.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            found[i] = jobs[i].is_in_roof ? finder.look_at_slope(jobs[i].storey, jobs[i].face)
                                          : finder.look_at(jobs[i].storey, jobs[i].face);
        }
    });
    std::vector<WallOpening> sides;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (!jobs[i].is_in_roof) {
            const std::size_t wall = surfaces.storeys[jobs[i].storey].wall_of_face[jobs[i].face];
            surfaces.surfaces[wall].component.evidence.occluded = found[i].hidden;
        }
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
    fit_door_sides(map.cloud, sample, surfaces, result.openings, context);
    result.components = make_opening_components(result.openings, surfaces);
    return result;
}

}  // namespace roomscribe
