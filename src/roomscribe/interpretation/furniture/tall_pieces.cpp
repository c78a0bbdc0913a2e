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
/// Fewer voxels are no side of a tall piece: 1.2 m x 8 cm in 4 cm.
constexpr std::size_t min_voxels = 60;
/// m: handles and overhangs.
constexpr double beside = 0.06;

/// A column of space over a square of the plan.
struct Column {
    std::array<std::int32_t, 4> key{};  ///< storey, room, x, y
    std::uint32_t voxel = 0;
};

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
    for (std::size_t begin = 0, end = 0; begin < columns.size(); begin = end) {
        std::bitset<num_levels> filled;
        double top = 0.0;
        for (; end < columns.size() && columns[end].key == columns[begin].key; ++end) {
            const double height = all.voxels[columns[end].voxel].height;
            top = std::max(top, height);
            if (height < filled_from || height >= filled_to) continue;
            filled.set(std::min(static_cast<std::size_t>((height - filled_from) / level_height),
                                num_levels - 1));
        }
        if (top < min_tall || filled.count() < min_filled_levels) continue;
        for (std::size_t k = begin; k < end; ++k)
            tall.push_back(columns[k].voxel);
    }
    std::sort(tall.begin(), tall.end());
    return tall;
}

PlanRectangle rectangle_around(const FurnitureVoxels& all, std::span<const std::uint32_t> members) {
    std::vector<Eigen::Vector2d> places;
    for (const std::uint32_t i : members)
        places.push_back(all.voxels[i].place.head<2>());
    return smallest_rectangle(places);
}

}  // namespace

std::vector<PieceDraft> draft_tall_pieces(FurnitureVoxels& all) {
    const std::vector<std::uint32_t> tall = find_tall_voxels(all);
    std::vector<bool> is_tall(all.voxels.size(), false);
    for (const std::uint32_t i : tall)
        is_tall[i] = true;
    std::vector<PieceDraft> drafts;
    for (const std::vector<std::uint32_t>& sides : connected_voxels(all, tall, is_tall)) {
        if (sides.size() < min_voxels) continue;
        for (const std::vector<std::uint32_t>& part : cut_row(all, sides)) {
            const PlanRectangle rectangle = rectangle_around(all, part);
            const FurnitureVoxel& some = all.voxels[part.front()];
            PieceDraft draft;
            for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
                FurnitureVoxel& voxel = all.voxels[i];
                if (!voxel.is_core || voxel.room != some.room || voxel.storey != some.storey)
                    continue;
                if (rectangle.distance(voxel.place.head<2>()) > beside) continue;
                draft.voxels.push_back(i);
                voxel.is_core = false;
            }
            if (!draft.voxels.empty()) drafts.push_back(std::move(draft));
        }
    }
    return drafts;
}

std::vector<PieceDraft> draft_hanging_pieces(FurnitureVoxels& all) {
    std::vector<bool> is_high(all.voxels.size(), false);
    std::vector<std::uint32_t> high;
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        is_high[i] = all.voxels[i].is_core && all.voxels[i].height > filled_to;
        if (is_high[i]) high.push_back(i);
    }
    std::vector<PieceDraft> drafts;
    for (std::vector<std::uint32_t>& members : connected_voxels(all, high, is_high)) {
        double bottom = std::numeric_limits<double>::infinity();
        for (const std::uint32_t i : members)
            bottom = std::min(bottom, all.voxels[i].height);
        if (bottom < min_tall) continue;
        for (const std::uint32_t i : members)
            all.voxels[i].is_core = false;
        drafts.push_back({std::move(members), {}});
    }
    return drafts;
}

}  // namespace roomscribe
