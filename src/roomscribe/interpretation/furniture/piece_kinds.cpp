// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"
#include "roomscribe/interpretation/furniture/row_cuts.hpp"

namespace roomscribe {
namespace {

/// m: pieces stand 16 to 35 mm off the wall for its skirting board, and voxels are 4 cm.
constexpr double wall_reach = 0.12;
/// m: no cabinet is deeper.
constexpr double max_hidden_depth = 0.7;
/// m before the wall: radiators are 5 to 12 cm thick and 3 to 6 off the wall, curtains hang as
/// near.
constexpr double max_thin_depth = 0.22;
/// m above the floor: what stands shows something lower, unless other things hide it.
constexpr double max_standing_bottom = 0.5;
/// m above the floor: wall units begin at 1.35, shelves over a sofa or desk lower.
constexpr double min_hanging_bottom = 0.9;

/// Share of a side that upright surface closes, of the one that is closed most: the others may not
/// have been seen. Legs stand at corners and rungs run low, so a side counts in columns, which are
/// closed if most of their height is.
double closed_share(const FurnitureVoxels& all, const PieceDraft& draft,
                    const PlanRectangle& rectangle, double below) {
    // m: worktops overhang by 20 to 40 mm, plinths are set back 50; of a stool it is no leg's
    // place.
    const double rim = std::min(0.12, 0.15 * rectangle.width);
    constexpr double lowest = 0.1;  // m: plinths and castors
    constexpr double column_width = 0.1;
    constexpr double min_fill = 0.6;
    const std::size_t columns =
        std::max<std::size_t>(3, static_cast<std::size_t>(rectangle.length / column_width));
    const auto rows = static_cast<std::size_t>(std::max(1.0, (below - lowest) / all.reach));
    // The short sides only of what is nearly square.
    const bool has_short = rectangle.width >= 0.7 * rectangle.length;
    std::array<std::vector<bool>, 4> is_filled;
    is_filled.fill(std::vector<bool>(columns * rows, false));
    const auto bin = [](double share, std::size_t bins) {
        return static_cast<std::size_t>(
            std::clamp(share * static_cast<double>(bins), 0.0, static_cast<double>(bins) - 1.0));
    };
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (!voxel.is_upright || voxel.height < lowest || voxel.height >= below) continue;
        const Eigen::Vector2d from_center = voxel.place.head<2>() - rectangle.center;
        const double u = from_center.dot(rectangle.axis);
        const double v = from_center.dot(rectangle.across());
        const std::size_t row = columns * bin((voxel.height - lowest) / (below - lowest), rows);
        if (0.5 * rectangle.width - std::abs(v) < rim)
            is_filled[v < 0.0 ? 0 : 1][row + bin(u / rectangle.length + 0.5, columns)] = true;
        if (has_short && 0.5 * rectangle.length - std::abs(u) < rim)
            is_filled[u < 0.0 ? 2 : 3][row + bin(v / rectangle.width + 0.5, columns)] = true;
    }
    std::size_t most = 0;
    for (const std::vector<bool>& side : is_filled) {
        std::size_t closed = 0;
        for (std::size_t column = 0; column < columns; ++column) {
            std::size_t filled = 0;
            for (std::size_t row = 0; row < rows; ++row)
                filled += side[row * columns + column] ? 1U : 0U;
            closed += static_cast<double>(filled) >= min_fill * static_cast<double>(rows) ? 1U : 0U;
        }
        most = std::max(most, closed);
    }
    return static_cast<double>(most) / static_cast<double>(columns);
}

/// Share of the voxels of a box that lie on flat surface: of plants and people few do.
constexpr double min_planar = 0.5;

struct WallBehind {
    double depth = 0.0;        ///< m, from the wall to the front
    Eigen::Vector2d off_wall;  ///< unit vector
};

/// The wall that the piece stands at, if it does.
std::optional<WallBehind> wall_behind(const RoomSurfaces& surfaces, const FurnitureVoxel& voxel,
                                      const PlanRectangle& rectangle) {
    const StoreyLayout& storey = surfaces.storeys[voxel.storey];
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    std::optional<WallBehind> least;
    for (const WallFace& face : storey.faces) {
        if (face.room != voxel.room) continue;
        const Eigen::Vector2d normal = (axes * face.plane.normal).head<2>();
        const double to_center = normal.dot(rectangle.center) - face.plane.offset;
        const double half = 0.5 * (rectangle.length * std::abs(rectangle.axis.dot(normal)) +
                                   rectangle.width * std::abs(rectangle.across().dot(normal)));
        // Of a cabinet before a wall only the front may have been seen.
        if (to_center - half > max_hidden_depth || to_center < -wall_reach) continue;
        const Eigen::Vector2d along = (axes * face.along).head<2>();
        const double at = along.dot(rectangle.center);
        if (at < face.start || at > face.end) continue;
        const double depth = to_center + half;
        if (!least || depth < least->depth) least = WallBehind{depth, normal};
    }
    return least;
}

/// What stands close before a wall and is thin: no furniture.
PieceVerdict judge_thin(const PieceForm& form) {
    PieceVerdict verdict;
    const double height = form.top - form.bottom;
    if (form.top <= 1.1 && form.bottom <= 0.35 && height >= 0.2 && form.rectangle.length >= 0.3) {
        verdict.kind = "radiator";
        verdict.rule = "thin low thing before a wall";
        verdict.confidence = 0.7;
    } else if (form.top > 1.7 && form.bottom < 0.8) {
        verdict.kind = "curtain";
        verdict.rule = "thin thing before a wall from its upper end down";
        verdict.confidence = 0.5;
    }
    return verdict;
}

struct Range {
    double low;
    double high;
    bool holds(double value) const { return value >= low && value <= high; }
};

PieceVerdict furniture(std::string_view kind, std::string_view rule, double confidence,
                       std::string_view alternative = {}) {
    return {true, kind, rule, alternative, confidence};
}

PieceVerdict judge_hanging(const PieceForm& form) {
    const double height = form.top - form.bottom;
    if (form.rectangle.length < 0.3) return {};
    // Kitchens' wall units are 0.30 to 0.37 deep, more with a door open; a board for books 0.15 to
    // 0.3.
    if (height >= 0.4 && form.rectangle.length >= 0.38 && form.planar > 0.75 &&
        form.upright >= 0.3 && form.face >= 0.12 && Range{0.2, 0.75}.holds(form.depth))
        return furniture("wall_unit", "box that hangs on a wall", 0.8);
    if (form.is_at_wall && form.depth >= 0.12 && height < 0.5 && form.level >= 0.3 &&
        Range{0.12, 0.4}.holds(form.rectangle.width) && form.rectangle.length >= 0.5) {
        return furniture("wall_shelf", "board that hangs on a wall", 0.7);
    }
    return {};
}

/// Chests beside beds are nearly square and 0.45 to 0.65 high.
bool is_nightstand(const PieceForm& form) {
    constexpr double min_width = 0.3;
    constexpr double max_elongation = 1.45;
    constexpr double min_height = 0.45;
    return form.rectangle.width >= min_width && form.seat >= min_height &&
           form.rectangle.length <= max_elongation * form.rectangle.width;
}

PieceVerdict judge_low(const PieceForm& form) {
    const PlanRectangle& size = form.rectangle;
    // Cartons and bins.
    if (size.length < 0.8 && form.seat < 0.36) return {};
    if (size.length >= 1.75 && size.width >= 0.8 && Range{0.36, 0.7}.holds(form.seat) &&
        form.top < 1.3 && size.width <= 2.2 && (size.width > 1.15 || form.top < 0.7)) {
        return furniture("bed", "low surface of a bed's size", 0.8);
    }
    if (Range{0.65, 1.15}.holds(size.width) && form.top >= 0.6) {
        if (size.length > 1.2)
            return furniture("sofa", "seat of several with arms and a back", 0.8);
        return furniture("armchair", "seat with arms and a back", 0.75);
    }
    if (form.closed > 0.7) {
        if (size.length > 0.9) return furniture("tv_unit", "low closed box", 0.7);
        // Cartons, bags and heaters along walls are longer than deep, or lower.
        if (!is_nightstand(form)) return {};
        return furniture("nightstand", "low box of a nightstand's size", 0.65);
    }
    constexpr double min_bench_width = 0.28;
    if (size.width < min_bench_width) return {};
    if (size.width < 0.5 && size.length > 0.8) return furniture("bench", "long seat", 0.7);
    return furniture("coffee_table", "low table top", 0.7);
}

PieceVerdict judge_seat(const PieceForm& form) {
    const double across = form.rectangle.length;
    // Cushions and legs are less flat than boards, leaves less than either; a seat is 0.14 m2.
    constexpr double min_flat = 0.4;
    constexpr double min_seat_area = 0.14;
    if (across > 1.1 || (form.planar < min_flat && form.face < min_seat_area)) return {};
    // Wider than a chair, and closed or narrow: a low chest, or its front.
    constexpr double max_chair_width = 0.75;
    constexpr double min_chair_depth = 0.35;
    if (across > max_chair_width && (form.closed > 0.7 || form.rectangle.width < min_chair_depth))
        return judge_low(form);
    if (form.seat > max_seat && form.closed > 0.7)
        return furniture("drawer_unit", "low box of a drawer unit's size", 0.7);
    if (form.seat > max_seat)
        return furniture("chair", "level surface above a chair's seat", 0.3, "thing");
    if (form.top >= 0.65) {
        if (form.rectangle.width >= 0.7 && form.upright + form.level > 0.6)
            return furniture("armchair", "seat with arms and a back", 0.7);
        if (across > 0.6) return furniture("office_chair", "seat with a back, on a foot", 0.8);
        return furniture("chair", "seat with a back", 0.85);
    }
    // Stools are as deep as wide, 0.3 and more; cartons and bags are not.
    constexpr double min_stool = 0.28;
    constexpr double max_elongation = 1.45;
    const bool is_square = form.rectangle.length <= max_elongation * form.rectangle.width;
    // Cartons and bins stand anywhere, small chests at a wall.
    if (form.closed > 0.7 && !form.is_at_wall) return {};
    if (form.closed > 0.7 && is_nightstand(form))
        return furniture("nightstand", "low box of a nightstand's size", 0.7);
    if (!is_square && form.rectangle.width >= 0.4) return judge_low(form);
    if (form.rectangle.width < min_stool || !is_square) return {};
    return furniture("stool", "seat without a back", 0.75);
}

PieceVerdict judge_table(const PieceForm& form) {
    const PlanRectangle& size = form.rectangle;
    // Window sills.
    if (form.is_at_wall && form.depth < 0.35 && size.width < 0.3) return {};
    if (form.closed > 0.7 && size.width <= 0.8) {
        if (size.length > 1.8 && size.width >= 0.5 && Range{0.82, 0.98}.holds(form.seat))
            return furniture("base_unit", "row of boxes under a worktop", 0.85);
        if (size.length <= 0.7 && size.width >= 0.4)
            return furniture("drawer_unit", "box of a drawer unit's size", 0.8);
        return furniture("cabinet", "closed box with a top", 0.85);
    }
    // Parts of tops, and what stands on some: no table is so small.
    constexpr double min_table_area = 0.35;
    if (size.area() < min_table_area)
        return furniture("table", "part of a top at a table's height", 0.3, "thing");
    if (form.seat > 0.85) {
        constexpr double min_counter_length = 1.0;
        const bool is_long = size.length >= min_counter_length;
        if (!is_long && form.upright >= 0.78 && form.planar >= 0.9) {
            return furniture(size.length <= 0.65 ? "drawer_unit" : "cabinet",
                             "box at a counter's height", 0.65);
        }
        return furniture("counter", "top at a counter's height", is_long ? 0.7 : 0.3,
                         is_long ? "" : "thing");
    }
    // Desks are 0.6 deep at least; what is less is a part, or the back of a sofa.
    constexpr double min_table_width = 0.5;
    constexpr double partly_closed = 0.4;
    if (size.width < min_table_width && form.is_at_wall && form.closed >= partly_closed)
        return furniture("cabinet", "top of a cabinet's depth at a wall", 0.65);
    if (size.width < min_table_width)
        return furniture("table", "part of a top at a table's height", 0.3, "thing");
    if (size.width <= 0.85 && size.length >= 1.0)
        return furniture("desk", "top at a desk's height, open below", 0.85);
    return furniture("table", "top at a table's height, open below", 0.8);
}

/// A front without a wall behind it that ends lower than leaves and walls do, as fridges' and
/// cupboards' do; where noise is strong, the ends of walls do as well.
bool is_low_front(const PieceForm& form) {
    constexpr double max_blur = 0.06;
    constexpr double max_top = 1.9;
    constexpr double max_bottom = 0.2;
    return form.blur <= max_blur && form.top <= max_top && form.bottom <= max_bottom &&
           form.rectangle.length >= 0.5 && form.face >= 0.6 * form.surface;
}

PieceVerdict judge_tall(const PieceForm& form) {
    const PlanRectangle& size = form.rectangle;
    if (form.planar < min_planar || form.face < 0.2) return {};
    // Of a box a front, a side and a top are seen; between boards there are many faces.
    const bool may_be_open = form.level >= 0.08 && size.length >= 0.6 && form.depth <= 0.6;
    if (form.face < 0.25 * form.surface && !may_be_open) return {};
    // A leaf that stands open and a wall beyond a doorway are thin; of a front the wall is as far
    // behind as the piece is deep.
    constexpr double min_width = 0.24;
    const bool is_thin = size.width - form.blur < min_width;
    if (is_thin && !Range{0.25, 0.85}.holds(form.depth) && !is_low_front(form)) return {};
    // DIN 18101: leaves are 1.985 and 2.11 high, and to 1.0 wide.
    if (is_thin && size.length <= 1.05 && Range{1.93, 2.15}.holds(form.top)) return {};
    // Noise makes layers of walls, which look like boxes; wardrobes stand before a wall.
    constexpr double strong_blur = 0.08;
    constexpr double max_free = 1.1;
    if (form.depth == 0.0 && form.blur > strong_blur && size.length > max_free) return {};
    // Columns and pipes.
    if (form.reaches_ceiling && size.length < 0.6) return {};
    if (size.length < 0.38) return {};
    if (size.width <= 0.5 && (form.num_slabs >= 2 || form.level > 0.15))
        return furniture("shelf", "boards above each other", 0.8);
    if (Range{0.5, 0.75}.holds(size.length) && size.width >= 0.45)
        return furniture("fridge", "tall box of a fridge's size", 0.7);
    if (size.width >= 0.5) return furniture("wardrobe", "tall deep box", 0.75);
    return furniture("cabinet", "tall box", 0.75);
}

/// m above the floor: cartons and bins are lower; a scanner sees the top of a lower cabinet.
constexpr double min_plain_top = 0.55;
/// Of what is nothing but boards and fronts; limbs and leaves make patches too where noise is high.
constexpr double mostly_planar = 0.8;

/// The back of a chair that is pushed under a table, which hides its seat.
bool is_chair_back(const PieceForm& form) {
    // m: seats lie at 0.40 to 0.52, backs end at 0.8 to 1.2 and are 0.4 to 0.6 wide.
    constexpr double min_bottom = 0.35;
    constexpr double max_bottom = 0.75;
    constexpr double wall_distance = 0.5;  // screens hang or stand nearer
    return Range{min_bottom, max_bottom}.holds(form.bottom) && Range{0.75, 1.2}.holds(form.top) &&
           Range{0.38, 0.75}.holds(form.rectangle.length) && form.upright >= 0.7 &&
           form.planar >= mostly_planar && (form.depth == 0.0 || form.depth > wall_distance);
}

/// A box of which two sides are seen, or its front alone, before a wall, and higher than radiators
/// are (0.7) and a desk's side panels (0.75).
bool is_box_at_wall(const PieceForm& form) {
    constexpr double min_front = 0.6;    // share of what is seen
    constexpr double min_length = 0.42;  // m: drawer units are 0.42 wide and more
    constexpr double max_depth = 0.8;
    const bool is_smooth = form.planar >= 0.88;
    const bool is_face = form.face >= min_front * form.surface && form.upright >= 0.75;
    const bool has_two_sides = form.top >= 0.7 && form.rectangle.width >= 0.35 &&
                               form.bottom <= 0.35 && (is_smooth || is_face);
    const bool has_front =
        form.top >= 0.78 && form.rectangle.length >= min_length && form.bottom <= 0.2 && is_face;
    return (has_two_sides || has_front) && Range{0.35, max_depth}.holds(form.depth) &&
           form.rectangle.width <= max_depth && form.upright >= 0.62;
}

/// What stands in the open and is as large as a chair, with more than upright surface. Plants and
/// radiators stand at walls, drawer units are lower or show their tops.
bool is_chair_in_open(const PieceForm& form) {
    constexpr double min_clearance = 0.78;  // m: of its front from a wall
    constexpr double max_back = 0.45;       // m2, more than the back of any office chair
    return (form.depth == 0.0 || form.depth >= min_clearance) && Range{0.8, 1.2}.holds(form.top) &&
           form.bottom <= max_standing_bottom && Range{0.44, 0.75}.holds(form.rectangle.length) &&
           form.rectangle.width >= 0.22 && form.planar >= 0.4 && form.upright <= 0.93 &&
           form.face >= 0.08 && form.face <= max_back;
}

/// The fronts of a kitchen's row whose worktop was not seen.
bool is_row_front(const PieceForm& form) {
    const double depth = form.depth > 0.0 ? form.depth : form.rectangle.width;
    return form.bottom <= 0.25 && Range{0.75, 1.0}.holds(form.front_top) &&
           Range{1.2, 5.0}.holds(form.rectangle.length) && Range{0.5, 0.8}.holds(depth) &&
           form.upright >= 0.75 && form.planar >= 0.9;
}

/// Things without a slab whose top is that of a chair or low cabinet. A cabinet of which only
/// sides are seen stands before a wall.
///
/// A third of those with a confidence under a half are right over simulated scenes: they are part
/// of the furniture, but not listed.
PieceVerdict judge_plain(const PieceForm& form) {
    const PlanRectangle& size = form.rectangle;
    if (form.top < 0.4 || size.length < 0.25) return {};
    if (is_chair_back(form)) return furniture("chair", "back of a chair, its seat hidden", 0.65);
    if (form.bottom > max_standing_bottom) return {};
    if (is_row_front(form)) return furniture("base_unit", "fronts of a row before a wall", 0.65);
    if (is_box_at_wall(form)) {
        return size.length <= 0.65
                   ? furniture("drawer_unit", "sides of a box of a drawer unit's size", 0.65)
                   : furniture("cabinet", "sides of a box before a wall", 0.65);
    }
    if (is_chair_in_open(form)) return furniture("chair", "size of a chair, in the open", 0.65);
    const double surface = form.surface;
    if (size.length > 2.5 && size.width > 1.2) return {};
    if (form.planar >= min_planar && form.upright >= 0.5 && size.length >= 0.35 &&
        form.top >= min_plain_top && Range{0.22, 0.75}.holds(form.depth) && form.face >= 0.12 &&
        form.face >= 0.25 * surface) {
        return furniture("cabinet", "upright sides of a box, top not seen", 0.3, "thing");
    }
    if (Range{0.7, 1.2}.holds(form.top) && Range{0.35, 0.95}.holds(size.length) &&
        form.planar > 0.4 && form.face >= 0.15 * surface)
        return furniture("chair", "size of a chair", 0.3, "thing");
    return {};
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

}  // namespace

PieceForm measure_form(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                       const PieceDraft& draft, const RoomSurfaces& surfaces) {
    PieceForm form;
    form.num_voxels = draft.voxels.size();
    form.num_slabs = draft.slabs.size();
    if (draft.voxels.empty()) return form;
    std::vector<double> heights;
    std::vector<Eigen::Vector2d> places;
    std::size_t num_level = 0;
    std::size_t num_upright = 0;
    std::size_t num_planar = 0;
    std::vector<std::uint32_t> of_patches;
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        heights.push_back(voxel.height);
        places.emplace_back(voxel.place.head<2>());
        num_level += voxel.is_level ? 1U : 0U;
        num_upright += voxel.is_upright ? 1U : 0U;
        num_planar += voxel.is_planar ? 1U : 0U;
        if (voxel.patch != off_patch) of_patches.push_back(voxel.patch);
    }
    const auto share = [&](std::size_t count) {
        return static_cast<double>(count) / static_cast<double>(draft.voxels.size());
    };
    form.level = share(num_level);
    form.upright = share(num_upright);
    form.rectangle = smallest_rectangle(places);
    form.bottom = quantile(heights, 0.01);
    form.top = quantile(heights, 0.99);
    form.front_top = front_top(all, draft.voxels);
    const FurnitureVoxel& some = all.voxels[draft.voxels.front()];
    std::vector<double> noise;
    for (const std::uint32_t i : draft.voxels)
        noise.push_back(all.voxels[i].noise);
    form.blur = 4.0 * median(noise);  // two deviations on either side
    form.planar = share(num_planar);
    std::sort(of_patches.begin(), of_patches.end());
    std::size_t largest = 0;
    for (std::size_t begin = 0, end = 0; begin < of_patches.size(); begin = end) {
        while (end < of_patches.size() && of_patches[end] == of_patches[begin])
            ++end;
        largest = std::max(largest, end - begin);
    }
    const double voxel_area = 0.25 * all.reach * all.reach;
    form.surface = voxel_area * static_cast<double>(draft.voxels.size());
    form.face = voxel_area * static_cast<double>(largest);
    if (const auto wall = wall_behind(surfaces, some, form.rectangle)) {
        form.depth = wall->depth;
        form.off_wall = wall->off_wall;
        form.is_at_wall = wall->depth - form.rectangle.width <= wall_reach;
    }
    const PlanRoom& room =
        surfaces.storeys[some.storey].plan.rooms[static_cast<std::size_t>(some.room)];
    form.reaches_ceiling =
        room.ceiling_height && form.top > *room.ceiling_height - room.floor_height - 0.2;
    if (!draft.slabs.empty()) {
        const LevelSlab& main = slabs[draft.slabs.front()];
        form.seat = main.height;
        for (const std::size_t slab : draft.slabs)
            form.highest_slab = std::max(form.highest_slab, slabs[slab].height);
        form.closed = closed_share(all, draft, main.rectangle, main.height - 0.1);
    }
    return form;
}

PieceVerdict judge_piece(const PieceForm& form) {
    constexpr std::size_t min_voxels = 30;  // of 4 cm: 0.05 m2 of surface
    if (form.num_voxels < min_voxels) return {};
    if (form.depth > 0.0 && form.depth <= max_thin_depth) return judge_thin(form);
    if (form.bottom >= min_hanging_bottom) return judge_hanging(form);
    if (form.num_slabs == 0 && form.top < 1.25) return judge_plain(form);
    if (form.num_slabs == 0)
        return form.bottom <= max_standing_bottom || is_box_seen_above(form) ? judge_tall(form)
                                                                             : PieceVerdict{};
    // A screen on a low chest makes nothing tall of it.
    if (form.top >= 1.3 && form.highest_slab > 0.66) return judge_tall(form);
    if (form.seat <= 0.66) {
        const bool is_seat = form.seat >= 0.36 && form.rectangle.length <= 1.1;
        return is_seat ? judge_seat(form) : judge_low(form);
    }
    return judge_table(form);
}

bool has_fronts(std::string_view kind) {
    constexpr std::array<std::string_view, 9> closed{"cabinet",     "base_unit",  "wall_unit",
                                                     "drawer_unit", "nightstand", "tv_unit",
                                                     "wardrobe",    "fridge",     "counter"};
    return std::find(closed.begin(), closed.end(), kind) != closed.end();
}

}  // namespace roomscribe
