// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"

namespace roomscribe {
namespace {

struct Range {
    double low;
    double high;
    bool holds(double value) const { return value >= low && value <= high; }
    /// How far outside a value lies, in spreads: rims, noise and things beside make pieces look
    /// larger by a voxel or two, while what is smaller than half a voxel less is a part of one.
    double miss(double value) const {
        constexpr double below = 0.02;
        constexpr double above = 0.05;
        return std::max({(low - value) / below, (value - high) / above, 0.0});
    }
};

constexpr Range any{0.0, std::numeric_limits<double>::infinity()};

/// Share of the sides below a level that are closed: more or less than most of one side.
constexpr Range open{0.0, 0.7};
constexpr Range closed{0.7, 1.0};

/// How large a kind is, in m, with the usual spread (docs/furniture.md has the sources).
struct KindSizes {
    std::string_view kind;
    Range level;  ///< above the floor: seat, mattress or top; of what is taller, its upper end
    Range rise;   ///< from there to the upper end: backs and headboards, not what stands on tops
    Range length;
    Range width;
    Range below;        ///< open or closed
    bool is_at_wall;    ///< what has its size in the middle of a room is a carton
    double confidence;  ///< of what fits well
};

/// Pieces of which a seat, mattress or top was seen.
constexpr std::array<KindSizes, 16> sizes_by_level{{
    {"stool", {0.36, 0.56}, {0.00, 0.12}, {0.28, 0.48}, {0.28, 0.48}, open, false, 0.75},
    {"chair", {0.36, 0.56}, {0.14, 0.80}, {0.30, 0.60}, {0.20, 0.60}, any, false, 0.85},
    {"office_chair", {0.36, 0.56}, {0.14, 0.80}, {0.60, 1.10}, {0.35, 0.75}, any, false, 0.80},
    {"armchair", {0.30, 0.56}, {0.10, 0.75}, {0.65, 1.15}, {0.65, 1.15}, any, false, 0.75},
    {"sofa", {0.30, 0.60}, {0.10, 0.75}, {1.20, 2.70}, {0.65, 1.15}, any, false, 0.80},
    {"bed", {0.36, 0.70}, {0.00, 0.70}, {1.75, 2.40}, {0.80, 2.20}, any, false, 0.80},
    {"bench", {0.36, 0.56}, {0.00, 0.12}, {0.80, 2.40}, {0.28, 0.50}, open, false, 0.70},
    {"coffee_table", {0.34, 0.56}, {0.00, 0.35}, {0.50, 1.60}, {0.40, 1.20}, open, false, 0.70},
    {"tv_unit", {0.30, 0.66}, any, {0.90, 2.80}, {0.28, 0.65}, any, true, 0.70},
    {"nightstand", {0.45, 0.66}, any, {0.30, 0.65}, {0.30, 0.60}, closed, true, 0.70},
    {"desk", {0.66, 0.85}, any, {1.00, 2.10}, {0.50, 0.85}, open, false, 0.85},
    {"table", {0.66, 0.85}, any, {0.60, 4.20}, {0.50, 1.60}, any, false, 0.80},
    {"counter", {0.85, 1.20}, any, {1.00, 6.00}, {0.40, 1.20}, open, false, 0.70},
    {"drawer_unit", {0.50, 1.20}, any, {0.40, 0.70}, {0.40, 0.80}, closed, false, 0.80},
    {"base_unit", {0.82, 0.98}, any, {1.80, 6.00}, {0.50, 0.90}, closed, false, 0.85},
    {"cabinet", {0.66, 1.25}, any, {0.40, 3.00}, {0.25, 0.80}, closed, false, 0.84},
}};

/// Boxes whose top was not seen, by their front's upper end: higher than radiators (0.7).
constexpr std::array<KindSizes, 3> sizes_by_front{{
    {"drawer_unit", {0.70, 1.20}, any, {0.40, 0.65}, {0.35, 0.80}, any, false, 0.65},
    {"cabinet", {0.70, 1.25}, any, {0.65, 3.00}, {0.35, 0.80}, any, false, 0.65},
    {"base_unit", {0.75, 1.00}, any, {1.20, 5.00}, {0.50, 0.80}, any, false, 0.66},
}};

/// Boxes that are taller than a table, chair or chest.
constexpr std::array<KindSizes, 4> sizes_of_tall{{
    {"shelf", {1.25, 2.70}, any, {0.38, 3.20}, {0.15, 0.50}, open, false, 0.80},
    {"fridge", {1.25, 2.10}, any, {0.50, 0.75}, {0.45, 0.75}, closed, false, 0.76},
    {"wardrobe", {1.25, 2.70}, any, {0.50, 4.00}, {0.50, 0.85}, closed, false, 0.75},
    {"cabinet", {1.25, 2.70}, any, {0.38, 4.00}, {0.20, 0.50}, closed, false, 0.75},
}};

/// m before the wall: radiators are 5 to 12 cm thick and 3 to 6 off the wall, curtains hang as
/// near.
constexpr double max_thin_depth = 0.22;
/// m above the floor: what stands shows something lower, unless other things hide it.
constexpr double max_standing_bottom = 0.5;
/// m above the floor: wall units begin at 1.35, shelves over a sofa or desk lower.
constexpr double min_hanging_bottom = 0.9;
/// m above the floor: what is taller is no table, chair or chest.
constexpr double min_tall = 1.25;
/// m2, of the front of a small chest (0.42 x 0.5).
constexpr double min_face = 0.2;
/// m: of a box before a wall, from the wall to its front.
constexpr Range box_depth{0.35, 0.8};

PieceVerdict furniture(std::string_view kind, std::string_view rule, double confidence) {
    return {true, kind, rule, {}, confidence};
}

/// What a draft shows of the sizes in the tables.
struct Sizes {
    double level;
    double rise;
    double length;
    double width;
    double closed;
    bool is_at_wall;
    double seat_share = 1.0;  ///< of the plan, that its main slab covers
};

/// The row that fits best; misses count as those of normal distributions.
PieceVerdict best_fit(std::span<const KindSizes> rows, const Sizes& sizes, std::string_view rule) {
    PieceVerdict best;
    for (const KindSizes& row : rows) {
        double misses = 0.0;
        const auto add = [&](double miss) { misses += miss * miss; };
        add(row.level.miss(sizes.level));
        add(row.rise.miss(sizes.rise));
        add(row.length.miss(sizes.length));
        add(row.width.miss(sizes.width));
        constexpr double closed_spread = 0.15;
        add(std::max({row.below.low - sizes.closed, sizes.closed - row.below.high, 0.0}) /
            closed_spread);
        add(row.is_at_wall && !sizes.is_at_wall ? 1.0 : 0.0);
        // The pot of a plant is no seat of what is upholstered.
        constexpr double min_cushion = 0.25;
        constexpr double cushion_spread = 0.1;
        if (row.width.low >= 0.65 && row.level.high <= 0.6)
            add(std::max(min_cushion - sizes.seat_share, 0.0) / cushion_spread);
        const double confidence = row.confidence * std::exp(-0.5 * misses);
        if (confidence > best.confidence) best = furniture(row.kind, rule, confidence);
    }
    return best;
}

/// m above the floor: radiators stand below sills.
constexpr double max_radiator = 0.95;

/// Shoe cabinets are 0.17 to 0.28 deep, higher than radiators and no wider than two doors.
bool is_shoe_cabinet(const PieceForm& form) {
    return form.is_at_wall && Range{0.15, 0.3 + form.blur}.holds(form.depth) &&
           form.rectangle.width - form.blur <= 0.3 && form.bottom <= 0.35 &&
           Range{max_radiator, 1.35}.holds(form.top) &&
           Range{0.45, 1.3}.holds(form.rectangle.length) && form.upright >= 0.8 &&
           form.face >= 0.6 * form.surface;
}

/// What stands close before a wall and is thin: no furniture.
PieceVerdict judge_thin(const PieceForm& form) {
    const double height = form.top - form.bottom;
    if (form.top <= max_radiator && form.bottom <= 0.35 && height >= 0.2 &&
        form.rectangle.length >= 0.3)
        return {false, "radiator", "thin low thing before a wall", {}, 0.7};
    if (form.top > 1.7 && form.bottom < 0.8)
        return {false, "curtain", "thin thing before a wall from its upper end down", {}, 0.5};
    return {};
}

PieceVerdict judge_hanging(const PieceForm& form) {
    const double height = form.top - form.bottom;
    const PlanRectangle& size = form.rectangle;
    // Kitchens' wall units are 0.30 to 0.37 deep, more with a door open; a board for books 0.15 to
    // 0.3.
    constexpr double max_unit = 1.25;  // m: what is taller is a column or a lining
    if (height >= 0.4 && height - form.blur <= max_unit && size.length >= 0.3 &&
        form.planar > 0.75 && form.upright >= 0.3 && form.face >= 0.12 &&
        Range{0.2, 0.75}.holds(form.depth))
        return furniture("wall_unit", "box that hangs on a wall", 0.8);
    if (form.is_at_wall && form.depth >= 0.12 && height < 0.5 && form.level >= 0.3 &&
        Range{0.12, 0.4}.holds(size.width) && size.length >= 0.5)
        return furniture("wall_shelf", "board that hangs on a wall", 0.7);
    return {};
}

/// Limbs and leaves bend: no part of plants and people is flat and as large as a seat (0.14 m2).
bool is_bent(const PieceForm& form) {
    constexpr double min_planar = 0.4;
    constexpr double seat_area = 0.14;
    return form.planar < min_planar && form.face < seat_area;
}

/// A front or a wall without its depth: a row of boards is 0.24 deep and more.
bool is_sheet(const PieceForm& form) {
    return form.rectangle.width - form.blur < 0.24;
}

/// m: of a piece of which only the front is seen, the wall is as far behind as the piece is deep.
constexpr Range hidden_depth{0.25, 0.85};

/// Where nothing tells how deep a front's piece is, as deep as most.
double depth_of(const PieceForm& form) {
    if (!is_sheet(form)) return form.rectangle.width;
    return hidden_depth.holds(form.depth) ? form.depth : 0.5;
}

/// m: single doors of cupboards are 0.3 to 0.6 wide. So are sides of furniture, leaves that were
/// seen in part, pilasters and ends of walls.
constexpr double max_narrow_front = 0.65;

/// A narrow front that is flat all over, of a cupboard's height, with the wall behind it.
bool is_narrow_front(const PieceForm& form) {
    constexpr double mostly = 0.8;
    constexpr double min_area = 0.8;  // m2
    return hidden_depth.holds(form.depth) && form.top <= 1.9 && form.face >= min_area &&
           form.face >= mostly * form.surface;
}

/// Walls beyond doorways, leaves that stand open, layers that noise makes of walls, columns.
bool is_of_building(const PieceForm& form) {
    const PlanRectangle& size = form.rectangle;
    // Without a wall behind it a front ends lower than leaves do, where noise lets one tell.
    const bool is_low_front = form.blur <= 0.06 && form.top <= 1.9 && form.bottom <= 0.2 &&
                              size.length >= 0.5 && form.face >= 0.6 * form.surface;
    if (is_sheet(form) && !hidden_depth.holds(form.depth) && !is_low_front) return true;
    if (is_sheet(form) && size.length <= max_narrow_front && !is_narrow_front(form)) return true;
    // What is narrow stands at walls.
    if (form.depth <= 0.0 && size.length < 0.6) return true;
    // DIN 18101: leaves are 1.985 and 2.11 high, and to 1.0 wide.
    if (is_sheet(form) && size.length <= 1.05 && Range{1.93, 2.15}.holds(form.top)) return true;
    if (form.depth == 0.0 && form.blur > 0.08 && size.length > 1.1) return true;
    return form.reaches_ceiling && size.length < 0.6;
}

/// Of a box a front, a side and a top are seen, one of them large; between boards there are many.
bool is_tall_box(const PieceForm& form) {
    const bool may_be_open =
        form.level >= 0.08 && form.rectangle.length >= 0.6 && form.depth <= 0.6;
    return form.planar >= 0.5 && form.face >= min_face &&
           (form.face >= 0.25 * form.surface || may_be_open);
}

PieceVerdict judge_tall(const PieceForm& form) {
    if (!is_tall_box(form) || is_of_building(form)) return {};
    const bool has_boards = form.num_slabs >= 2 || form.level > 0.15;
    const PlanRectangle& size = form.rectangle;
    return best_fit(
        sizes_of_tall,
        {form.top, 0.0, size.length, depth_of(form), has_boards ? 0.6 : 1.0, form.is_at_wall},
        has_boards ? "boards above each other" : "tall box");
}

/// A box of which two sides are seen, or its front alone, before a wall.
PieceVerdict judge_box(const PieceForm& form) {
    const PlanRectangle& size = form.rectangle;
    const bool is_face = form.face >= 0.6 * form.surface && form.upright >= 0.75;
    const bool has_two_sides =
        size.width >= box_depth.low && form.upright >= 0.62 && (form.planar >= 0.88 || is_face);
    // A desk's side panel ends at 0.75.
    const bool has_front = is_face && form.top >= 0.78 && form.bottom <= 0.25;
    if (form.bottom > box_depth.low || (!has_two_sides && !has_front)) return {};
    const double depth = form.depth > 0.0 ? form.depth : size.width;
    const bool is_row = size.length >= 1.2;
    if (!is_row && !box_depth.holds(form.depth)) return {};
    return best_fit(
        sizes_by_front,
        {is_row ? form.front_top : form.top, 0.0, size.length, depth, 0.0, form.is_at_wall},
        "sides of a box before a wall");
}

/// A chair whose seat was not seen and whose back was not parted from the rest: what is as large as
/// a chair and stands free of walls, where plants and radiators do not.
PieceVerdict judge_hidden_seat(const PieceForm& form) {
    const double clearance = form.depth == 0.0 ? any.high : form.depth;
    // m2, more than the back of any office chair; its foot and seat are not upright.
    constexpr double max_back = 0.45;
    const bool is_whole =
        Range{0.75, 1.2}.holds(form.top) && Range{0.38, 0.75}.holds(form.rectangle.length) &&
        form.bottom <= max_standing_bottom && form.rectangle.width >= 0.22 && form.planar >= 0.4 &&
        form.upright <= 0.93 && Range{0.08, max_back}.holds(form.face) && clearance >= 0.78;
    return is_whole ? furniture("chair", "size of a chair, in the open", 0.65) : PieceVerdict{};
}

/// A tall box before a wall whose lower part no ray reached, as scanners see it that look only so
/// far down: what hangs begins higher, what stands on something has that below.
bool is_box_seen_above(const PieceForm& form) {
    constexpr double min_seen = 0.5;    // m of its height
    constexpr double min_width = 0.15;  // m: a screen is thinner
    return form.bottom < min_hanging_bottom && form.top - form.bottom >= min_seen &&
           form.rectangle.width - form.blur >= min_width && Range{0.25, 0.75}.holds(form.depth) &&
           form.planar >= 0.9 && form.upright >= 0.85;
}

/// A low shelf: open, shallower than a table, with its upper board all over it, deeper than
/// radiators under their sills are.
bool is_low_shelf(const PieceForm& form) {
    const PlanRectangle& size = form.rectangle;
    constexpr double min_share = 0.6;
    return form.is_at_wall && form.bottom <= 0.3 && form.closed <= open.high &&
           Range{0.6, min_tall}.holds(form.seat) && Range{0.5, 2.0}.holds(size.length) &&
           Range{0.28, 0.47}.holds(size.width - form.blur) && form.face >= min_face &&
           form.seat_area >= min_share * size.area();
}

PieceVerdict judge_standing(const PieceForm& form) {
    const bool has_level = form.num_slabs > 0;
    const bool has_bottom = form.bottom <= max_standing_bottom;
    if (!has_level && form.top < min_tall) {
        const PieceVerdict chair = judge_hidden_seat(form);
        return chair.is_furniture || !has_bottom ? chair : judge_box(form);
    }
    if (!has_level)
        return has_bottom || is_box_seen_above(form) ? judge_tall(form) : PieceVerdict{};
    // A screen on a low chest makes nothing tall of it.
    if (form.top >= min_tall + 0.05 && form.highest_slab > min_table_height)
        return judge_tall(form);
    if (is_low_shelf(form)) return furniture("shelf", "low boards before a wall", 0.7);
    return best_fit(
        sizes_by_level,
        {form.seat, form.top - form.seat, form.rectangle.length, form.rectangle.width, form.closed,
         form.is_at_wall, form.seat_area / std::max(form.rectangle.area(), 1e-9)},
        form.seat > min_table_height ? "top of a table's or chest's height" : "seat or low top");
}

/// What stands, is as large as furniture and flat-sided, whatever it is.
bool is_of_furniture_size(const PieceForm& form) {
    constexpr double mostly_planar = 0.7;
    const PlanRectangle& size = form.rectangle;
    const bool is_tall = form.top > min_tall;
    return form.bottom <= box_depth.low && form.top >= 0.4 &&
           size.length >= (is_tall ? 0.6 : 0.4) && size.width - form.blur >= 0.18 &&
           form.planar >= mostly_planar && form.face >= min_face &&
           !(is_tall && (is_of_building(form) || form.reaches_ceiling));
}

}  // namespace

PieceVerdict judge_piece(const PieceForm& form) {
    constexpr std::size_t min_voxels = 30;  // of 4 cm: 0.05 m2 of surface
    if (form.num_voxels < min_voxels) return {};
    if (form.is_chair) return furniture("chair", "back of a chair, with what is below", 0.7);
    if (form.is_under_top) return furniture("drawer_unit", "box with a gap below a top", 0.75);
    if (is_bent(form)) return {};
    if (is_shoe_cabinet(form)) return furniture("cabinet", "shallow box before a wall", 0.6);
    if (form.depth > 0.0 && form.depth <= max_thin_depth) return judge_thin(form);
    if (form.bottom >= min_hanging_bottom) return judge_hanging(form);
    const PieceVerdict verdict = judge_standing(form);
    if (verdict.confidence >= min_piece_confidence) return verdict;
    if (!is_of_furniture_size(form)) return {};
    constexpr double unsure = 0.4;  // cartons are as flat-sided and as large
    return furniture("other", "flat-sided thing of furniture's size", unsure);
}

bool is_back_of_chair(const PieceForm& form) {
    constexpr double max_width = 0.5;  // m: of what bends around a person, with the noise
    return form.num_slabs == 0 && Range{0.35, 0.75}.holds(form.bottom) &&
           Range{0.75, 1.2}.holds(form.top) && Range{0.38, 0.75}.holds(form.rectangle.length) &&
           form.rectangle.width <= max_width && form.upright >= 0.7 &&
           (form.depth == 0.0 || form.depth > 0.5);
}

bool has_fronts(std::string_view kind) {
    constexpr std::array<std::string_view, 9> kinds{"cabinet",     "base_unit",  "wall_unit",
                                                    "drawer_unit", "nightstand", "tv_unit",
                                                    "wardrobe",    "fridge",     "counter"};
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace roomscribe
