// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/tall_pieces.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"
#include "roomscribe/interpretation/furniture/row_cuts.hpp"

namespace roomscribe {
namespace {

/// m above the floor: no table, chair or desk with a monitor on it is so tall (office chairs end at
/// 1.2), wardrobes, fridges and shelves are taller.
constexpr double min_tall = 1.25;
/// m above the floor, between which a tall piece shows its sides or front; plinths lie lower.
constexpr double filled_from = 0.3;
constexpr double filled_to = 1.2;
/// m and share: of the levels between, some may be hidden by what stands before.
constexpr double level_height = 0.1;
constexpr std::size_t num_levels = 9;
constexpr std::size_t min_filled_levels = 6;
/// m: of what stands on a worktop or a desk a column shows only what is higher.
constexpr double max_lowest = 0.7;
/// Fewer voxels are no side of a tall piece: 1.2 m x 8 cm in 4 cm.
constexpr std::size_t min_voxels = 60;
/// m: what stands shows a decimeter or two of itself below.
constexpr double below_hanging = 0.15;
/// Share of what hangs under which things stand that touch it, on a worktop or a table.
constexpr double max_standing = 0.25;
/// m: handles and overhangs.
constexpr double beside = 0.06;

/// A column of space over a square of the plan.
struct Column {
    std::array<std::int32_t, 4> key{};  ///< storey, room, x, y
    std::uint32_t voxel = 0;
};

/// m: between a kitchen's worktop and its wall units lie 0.45 and more, between boards less.
constexpr double max_board_gap = 0.44;

/// Whether something higher than `from` follows on a gap wider than one between boards. Heights
/// ascending.
bool has_gap(std::span<const double> heights, double from) {
    double last = from;
    for (const double height : heights) {
        if (height - last > max_board_gap) return true;
        last = std::max(last, height);
    }
    return false;
}

/// Whether a column ends at a worktop's height and goes on where wall units begin.
bool parts_at_worktop(std::span<const double> heights) {
    constexpr double lowest = 0.7;
    constexpr double highest = 1.3;
    for (std::size_t i = 1; i < heights.size(); ++i) {
        const double below = heights[i - 1];
        if (below >= lowest && below <= highest && heights[i] - below > max_board_gap) return true;
    }
    return false;
}

std::vector<std::uint32_t> find_tall_voxels(const FurnitureVoxels& all) {
    std::vector<Column> columns;
    const auto cell = [&](double at) {
        return static_cast<std::int32_t>(std::floor(at / all.reach));
    };
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (!voxel.is_core) continue;
        columns.push_back({{static_cast<std::int32_t>(voxel.storey), voxel.room,
                            cell(voxel.place.x()), cell(voxel.place.y())},
                           i});
    }
    std::sort(columns.begin(), columns.end(), [](const Column& a, const Column& b) {
        return std::tie(a.key, a.voxel) < std::tie(b.key, b.voxel);
    });
    std::vector<std::uint32_t> tall;
    std::vector<double> heights;
    for (std::size_t begin = 0, end = 0; begin < columns.size(); begin = end) {
        std::bitset<num_levels> filled;
        double top = 0.0;
        heights.clear();
        for (; end < columns.size() && columns[end].key == columns[begin].key; ++end) {
            const FurnitureVoxel& voxel = all.voxels[columns[end].voxel];
            const double height = voxel.height;
            top = std::max(top, height - voxel.noise);
            heights.push_back(height);
            if (height < filled_from || height >= filled_to) continue;
            filled.set(std::min(static_cast<std::size_t>((height - filled_from) / level_height),
                                num_levels - 1));
        }
        std::sort(heights.begin(), heights.end());
        if (top < min_tall || filled.count() < min_filled_levels) continue;
        if (heights.front() > max_lowest || parts_at_worktop(heights)) continue;
        for (std::size_t k = begin; k < end; ++k)
            tall.push_back(columns[k].voxel);
    }
    std::sort(tall.begin(), tall.end());
    return tall;
}

/// For each voxel whether its column goes on without a gap from where hanging things begin into the
/// decimeters below.
std::vector<bool> find_columns_below(const FurnitureVoxels& all) {
    constexpr double max_gap = 0.12;  // m: a voxel or two
    std::vector<std::array<std::int32_t, 4>> below;
    std::vector<std::array<std::int32_t, 4>> right_above;
    const auto key = [&](const FurnitureVoxel& voxel) {
        return std::array<std::int32_t, 4>{
            static_cast<std::int32_t>(voxel.storey), voxel.room,
            static_cast<std::int32_t>(std::floor(voxel.place.x() / all.reach)),
            static_cast<std::int32_t>(std::floor(voxel.place.y() / all.reach))};
    };
    for (const FurnitureVoxel& voxel : all.voxels) {
        if (!voxel.is_core) continue;
        if (voxel.height >= filled_to - below_hanging && voxel.height < min_tall)
            below.push_back(key(voxel));
        if (voxel.height >= min_tall && voxel.height < min_tall + max_gap)
            right_above.push_back(key(voxel));
    }
    std::sort(below.begin(), below.end());
    std::sort(right_above.begin(), right_above.end());
    std::vector<bool> found(all.voxels.size(), false);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto column = key(all.voxels[i]);
        found[i] = std::binary_search(below.begin(), below.end(), column) &&
                   std::binary_search(right_above.begin(), right_above.end(), column);
    }
    return found;
}

bool are_together(const FurnitureVoxel& a, const FurnitureVoxel& b) {
    return a.storey == b.storey && a.room == b.room;
}

/// Sides and fronts of one tall thing.
struct TallBox {
    std::vector<std::uint32_t> voxels;
    PlanRectangle rectangle;
    double top = 0.0;
};

TallBox make_box(const FurnitureVoxels& all, std::vector<std::uint32_t> members) {
    TallBox box;
    box.rectangle = smallest_rectangle(places_of(all, members));
    for (const std::uint32_t i : members)
        box.top = std::max(box.top, all.voxels[i].height);
    box.voxels = std::move(members);
    return box;
}

/// Whether what lies between two boxes fills the height as boards do: the gap between a kitchen's
/// worktop and wall units is wider (0.45 m and more) than that between boards.
bool is_bridged(const FurnitureVoxels& all, const TallBox& a, const TallBox& b,
                const PlanRectangle& both) {
    std::vector<double> heights;
    for (const FurnitureVoxel& voxel : all.voxels) {
        if (!voxel.is_core || !are_together(voxel, all.voxels[a.voxels.front()])) continue;
        const Eigen::Vector2d place = voxel.place.head<2>();
        if (both.distance(place) > 0.0 || a.rectangle.distance(place) <= 0.0 ||
            b.rectangle.distance(place) <= 0.0) {
            continue;
        }
        heights.push_back(voxel.height);
    }
    if (heights.size() < min_voxels) return false;
    std::sort(heights.begin(), heights.end());
    constexpr double plinth = 0.1;  // m
    return !has_gap(heights, plinth) && std::min(a.top, b.top) - heights.back() <= max_board_gap;
}

/// Sides of one shelf, or a front whose middle something hides: in line, of one height, with
/// boards between; or one within the other's rectangle.
void join_boxes(const FurnitureVoxels& all, std::vector<TallBox>& boxes) {
    constexpr double max_length = 2.6;    // m: a wardrobe of four doors
    constexpr double max_depth = 0.8;     // m
    constexpr double same_height = 0.12;  // m
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t j = i + 1; j < boxes.size();) {
            const TallBox& a = boxes[i];
            const TallBox& b = boxes[j];
            bool joins = are_together(all.voxels[a.voxels.front()], all.voxels[b.voxels.front()]);
            if (joins) {
                std::vector<std::uint32_t> members = a.voxels;
                members.insert(members.end(), b.voxels.begin(), b.voxels.end());
                std::sort(members.begin(), members.end());
                TallBox both = make_box(all, std::move(members));
                const double larger = std::max(a.rectangle.area(), b.rectangle.area());
                const bool is_within = both.rectangle.area() <= 1.1 * larger;
                const bool is_row =
                    std::abs(a.top - b.top) <= same_height && both.rectangle.length <= max_length &&
                    both.rectangle.width <= max_depth && is_bridged(all, a, b, both.rectangle);
                joins = is_within || is_row;
                if (joins) boxes[i] = std::move(both);
            }
            if (!joins) {
                ++j;
                continue;
            }
            boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(j));
            j = i + 1;
        }
    }
}

/// Whether it stands on the floor by what its columns show: screens on chests and tables do not,
/// which begin where chests end, at 0.4 m and higher.
bool stands_on_floor(const FurnitureVoxels& all, const TallBox& box) {
    constexpr double low = 0.45;
    constexpr double min_share = 0.3;  // of the columns; of others something hides the lower part
    std::vector<std::pair<std::array<std::int32_t, 2>, bool>> columns;
    for (const std::uint32_t i : box.voxels) {
        const Eigen::Vector3d& place = all.voxels[i].place;
        columns.push_back({{static_cast<std::int32_t>(std::floor(place.x() / all.reach)),
                            static_cast<std::int32_t>(std::floor(place.y() / all.reach))},
                           all.voxels[i].height >= low});
    }
    std::sort(columns.begin(), columns.end());
    std::size_t count = 0;
    std::size_t standing = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (i > 0 && columns[i].first == columns[i - 1].first) continue;
        ++count;
        standing += columns[i].second ? 0U : 1U;  // the lowest first
    }
    return static_cast<double>(standing) >= min_share * static_cast<double>(count);
}

}  // namespace

PlanRectangle extended_to_wall(PlanRectangle rectangle, const RoomSurfaces& surfaces,
                               const FurnitureVoxel& some) {
    constexpr double max_depth = 0.75;
    constexpr double parallel = 0.98;
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    for (const WallFace& face : surfaces.storeys[some.storey].faces) {
        if (face.room != some.room) continue;
        const Eigen::Vector2d normal = (axes * face.plane.normal).head<2>();
        const double at = (axes * face.along).head<2>().dot(rectangle.center);
        if (at < face.start || at > face.end) continue;
        const bool lies_along = std::abs(rectangle.across().dot(normal)) > parallel;
        if (!lies_along) continue;
        const double front =
            normal.dot(rectangle.center) + 0.5 * rectangle.width - face.plane.offset;
        if (front <= rectangle.width || front > max_depth) continue;
        rectangle.center -= 0.5 * (front - rectangle.width) * normal;
        rectangle.width = front;
        if (rectangle.width > rectangle.length) {
            rectangle.axis = rectangle.across();
            std::swap(rectangle.length, rectangle.width);
        }
        return rectangle;
    }
    return rectangle;
}

std::vector<PieceDraft> draft_tall_pieces(FurnitureVoxels& all, const RoomSurfaces& surfaces) {
    const std::vector<std::uint32_t> tall = find_tall_voxels(all);
    std::vector<bool> is_tall(all.voxels.size(), false);
    for (const std::uint32_t i : tall)
        is_tall[i] = true;
    std::vector<TallBox> boxes;
    for (const std::vector<std::uint32_t>& sides : connected_voxels(all, tall, is_tall)) {
        if (sides.size() < min_voxels) continue;
        for (std::vector<std::uint32_t>& part : cut_row(all, sides))
            boxes.push_back(make_box(all, std::move(part)));
    }
    join_boxes(all, boxes);
    std::vector<PieceDraft> drafts;
    for (const TallBox& box : boxes) {
        if (!stands_on_floor(all, box)) continue;
        const FurnitureVoxel& some = all.voxels[box.voxels.front()];
        const PlanRectangle rectangle = extended_to_wall(box.rectangle, surfaces, some);
        PieceDraft draft;
        for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
            FurnitureVoxel& voxel = all.voxels[i];
            if (!voxel.is_core || !are_together(voxel, some)) continue;
            if (voxel.height > box.top + beside) continue;
            if (rectangle.distance(voxel.place.head<2>()) > beside) continue;
            draft.voxels.push_back(i);
            voxel.is_core = false;
        }
        if (!draft.voxels.empty()) drafts.push_back(std::move(draft));
    }
    return drafts;
}

std::vector<PieceDraft> draft_hanging_pieces(FurnitureVoxels& all) {
    std::vector<bool> is_high(all.voxels.size(), false);
    std::vector<std::uint32_t> high;
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        is_high[i] = all.voxels[i].is_core && all.voxels[i].height >= min_tall;
        if (is_high[i]) high.push_back(i);
    }
    std::vector<bool> goes_on_below = find_columns_below(all);
    std::vector<PieceDraft> drafts;
    for (std::vector<std::uint32_t>& members : connected_voxels(all, high, is_high)) {
        const auto standing = std::count_if(members.begin(), members.end(),
                                            [&](std::uint32_t i) { return goes_on_below[i]; });
        if (static_cast<double>(standing) > max_standing * static_cast<double>(members.size()))
            continue;
        for (const std::uint32_t i : members)
            all.voxels[i].is_core = false;
        drafts.push_back({std::move(members), {}});
    }
    return drafts;
}

}  // namespace roomscribe
