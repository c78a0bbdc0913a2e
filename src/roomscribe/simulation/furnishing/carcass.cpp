// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "roomscribe/simulation/furnishing/furniture_fronts.hpp"

namespace roomscribe {
namespace {

constexpr double board = 0.018;  // thickness of a side

void add_things_on_board(ItemBuilder& builder, double back, double front, double y_low,
                         double y_high, double z, double room_above) {
    const std::uint32_t thing =
        builder.clutter(builder.chance(0.5) ? Material::paper : Material::fabric);
    double y = y_low + builder.pick(0.02, 0.1);
    while (y < y_high - 0.06) {
        const double width = std::min(builder.pick(0.05, 0.25), y_high - 0.01 - y);
        const double height = room_above * builder.pick(0.3, 0.85);
        const double reach = back + (front - back) * builder.pick(0.5, 0.9);
        builder.box(thing, {back + 0.01, y, z + 0.0005}, {reach, y + width, z + height});
        y += width + builder.pick(0.005, 0.12);
    }
}

/// Sides, top, bottom, back and shelf boards.
void add_hollow_carcass(ItemBuilder& builder, const FaceArea& area, double back, double front,
                        const FrontStyle& style) {
    const std::uint32_t part = builder.part(style.carcass);
    const double y0 = area.low.x();
    const double y1 = area.high.x();
    const double z0 = area.low.y();
    const double z1 = area.high.y();
    builder.box(part, {back, y0, z0}, {front, y0 + board, z1});
    builder.box(part, {back, y1 - board, z0}, {front, y1, z1});
    builder.box(part, {back, y0, z0}, {front, y1, z0 + board});
    builder.box(part, {back, y0, z1 - board}, {front, y1, z1});
    builder.box(part, {back, y0, z0}, {back + 0.008, y1, z1});
    const int num_levels = std::max(1, static_cast<int>(std::lround((z1 - z0) / 0.36)));
    const double pitch = (z1 - z0 - board) / num_levels;
    for (int level = 0; level < num_levels; ++level) {
        const double z = z0 + level * pitch;
        if (level > 0) {
            builder.box(part, {back, y0 + 0.001, z}, {front - 0.01, y1 - 0.001, z + board});
        }
        if (!builder.chance(0.8)) continue;
        add_things_on_board(builder, back + 0.008, front - 0.01, y0 + board, y1 - board, z + board,
                            pitch - board);
    }
}

}  // namespace

void add_carcass(ItemBuilder& builder, const FaceArea& area, const FrontStyle& style,
                 bool is_hollow) {
    const double back = -builder.depth() / 2.0 + style.back_space;
    const double front = area.x - style.thickness - style.setback;
    if (is_hollow) {
        add_hollow_carcass(builder, area, back, front, style);
    } else {
        builder.box(builder.part(style.carcass), {back, area.low.x(), area.low.y()},
                    {front, area.high.x(), area.high.y()});
    }
}

}  // namespace roomscribe
