// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "roomscribe/simulation/furnishing/furniture_fronts.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Material choose_wood(ItemBuilder& builder) {
    constexpr std::array woods{Material::wood, Material::wood, Material::dark_wood,
                               Material::lacquer};
    return woods[static_cast<std::size_t>(builder.choose(4))];
}

/// Foot of a piece: a plinth set back, or four legs. Returns its height.
double add_foot(ItemBuilder& builder, Material material, double height, bool has_legs) {
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const std::uint32_t part = builder.part(material);
    if (!has_legs) {
        builder.box(part, {-x, -y, 0.0}, {x - 0.03, y, height});
        return height;
    }
    for (const double side : {-1.0, 1.0}) {
        for (const double end : {-1.0, 1.0}) {
            const Vector3d at(end * (x - 0.05), side * (y - 0.05), 0.0);
            builder.cylinder(part, at, at + Vector3d(0.0, 0.0, height + 0.002), 0.018);
        }
    }
    return height;
}

FaceArea front_area(const ItemBuilder& builder, double low_z, double high_z) {
    return {
        builder.depth() / 2.0, {-builder.width() / 2.0, low_z}, {builder.width() / 2.0, high_z}};
}

/// The i-th of `count` equal bays from the right.
FaceArea bay_area(const FaceArea& area, int i, int count) {
    FaceArea bay = area;
    bay.low.x() = area.low.x() + area.width() * i / count;
    bay.high.x() = area.low.x() + area.width() * (i + 1) / count;
    return bay;
}

int bays_for(double width, double usual) {
    return std::max(1, static_cast<int>(std::lround(width / usual)));
}

/// A top plate that reaches over the front by a few millimetres.
void add_plate(ItemBuilder& builder, Material material, double thickness, double overhang) {
    builder.top(material,
                {-builder.depth() / 2.0, -builder.width() / 2.0, builder.height() - thickness},
                {builder.depth() / 2.0 + overhang, builder.width() / 2.0, builder.height()});
}

constexpr double plate = 0.022;
constexpr double seam = 0.0005;  // below it, so that no sides of two parts lie in one plane

/// Foot, top plate and one bay of drawers.
void build_drawers(ItemBuilder& builder, Material material, int num_rows, double foot,
                   bool has_legs) {
    builder.begin(Label::furniture, builder.item().kind);
    const FrontStyle style = choose_front_style(builder.random(), material);
    const double base = add_foot(builder, style.carcass, foot, has_legs);
    add_bay(builder, front_area(builder, base, builder.height() - plate - seam),
            BayContent::drawers, style, num_rows);
    add_plate(builder, style.carcass, plate, 0.003);
}

}  // namespace

void build_cabinet(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const FrontStyle style = choose_front_style(builder.random(), choose_wood(builder));
    const bool has_legs = builder.chance(0.3);
    const double base =
        add_foot(builder, style.carcass, has_legs ? 0.14 : builder.pick(0.05, 0.09), has_legs);
    const FaceArea front = front_area(builder, base, builder.height() - plate - seam);
    const int count = bays_for(builder.width(), 0.6);
    const int drawer_bay = builder.choose(2 * count);
    for (int i = 0; i < count; ++i) {
        const FaceArea bay = bay_area(front, i, count);
        const BayContent content = i == drawer_bay       ? BayContent::drawers
                                   : bay.width() > 0.65  ? BayContent::double_door
                                   : builder.chance(0.3) ? BayContent::drawer_and_door
                                                         : BayContent::door;
        add_bay(builder, bay, content, style, front.height() > 0.8 ? 4 : 3);
    }
    add_plate(builder, style.carcass, plate, 0.003);
}

void build_wardrobe(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    FrontStyle style = choose_front_style(builder.random(), choose_wood(builder));
    style.handle_height = HandleHeight::in_reach;
    style.has_level_door_handles = false;
    const double base = add_foot(builder, style.carcass, 0.08, false);
    const FaceArea front = front_area(builder, base, builder.height() - plate);
    const int count = bays_for(builder.width(), 0.95);
    const bool has_drawers = builder.chance(0.3);
    for (int i = 0; i < count; ++i) {
        FaceArea bay = bay_area(front, i, count);
        if (has_drawers) {
            FaceArea low = bay;
            bay.low.y() = low.high.y() = front.low.y() + 0.42;
            add_bay(builder, low, BayContent::drawers, style, 2);
        }
        add_bay(builder, bay, bay.width() > 0.65 ? BayContent::double_door : BayContent::door,
                style);
    }
    builder.box(builder.part(style.carcass),
                {-builder.depth() / 2.0, -builder.width() / 2.0, builder.height() - plate - 0.001},
                {builder.depth() / 2.0, builder.width() / 2.0, builder.height()});
}

void build_office_cupboard(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const bool is_steel = builder.chance(0.4);
    FrontStyle style =
        choose_front_style(builder.random(), is_steel ? Material::paint : Material::wood);
    style.is_framed = false;
    style.handle_height = HandleHeight::in_reach;
    style.has_level_door_handles = false;
    if (is_steel) style.carcass = Material::paint;
    if (is_steel || builder.chance(0.3)) {
        style.handle = {.shape = HandleShape::lever,
                        .hole_spacing = builder.pick(0.09, 0.12),
                        .diameter = builder.pick(0.012, 0.016),
                        .projection = builder.pick(0.035, 0.045),
                        .material = is_steel ? Material::black_plastic : Material::metal};
    }
    const double base = add_foot(builder, style.carcass, 0.06, false);
    const FaceArea front = front_area(builder, base, builder.height() - 0.02);
    FaceArea doors = front;
    if (!is_steel && builder.chance(0.35)) {
        FaceArea open = front;
        doors.high.y() = open.low.y() = front.low.y() + 0.5 * front.height();
        add_bay(builder, open, BayContent::shelves, style);
    }
    const int count = bays_for(builder.width(), 1.0);
    for (int i = 0; i < count; ++i)
        add_bay(builder, bay_area(doors, i, count), BayContent::double_door, style);
    builder.box(builder.part(style.carcass),
                {-builder.depth() / 2.0, -builder.width() / 2.0, builder.height() - 0.021},
                {builder.depth() / 2.0, builder.width() / 2.0, builder.height()});
}

void build_drawer_unit(ItemBuilder& builder) {
    const int rows = std::clamp(static_cast<int>(std::lround(builder.height() / 0.24)), 2, 5);
    const bool is_steel = builder.chance(0.4);
    build_drawers(builder, is_steel ? Material::paint : Material::wood, rows, 0.05,
                  builder.height() < 0.7);
}

void build_chest_of_drawers(ItemBuilder& builder) {
    const int rows = std::clamp(static_cast<int>(std::lround(builder.height() / 0.24)), 3, 5);
    const bool has_legs = builder.chance(0.4);
    build_drawers(builder, choose_wood(builder), rows, has_legs ? 0.13 : 0.06, has_legs);
}

void build_nightstand(ItemBuilder& builder) {
    const bool has_legs = builder.chance(0.5);
    const Material wood = choose_wood(builder);
    const int rows = 2 + builder.choose(2);
    build_drawers(builder, wood, rows, has_legs ? 0.15 : 0.04, has_legs);
}

void build_tv_unit(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const FrontStyle style = choose_front_style(builder.random(), choose_wood(builder));
    const bool has_legs = builder.chance(0.4);
    const double base = add_foot(builder, style.carcass, has_legs ? 0.12 : 0.04, has_legs);
    const FaceArea front = front_area(builder, base, builder.height() - plate - seam);
    const int count = std::max(2, bays_for(builder.width(), 0.55));
    const int open_bay = builder.choose(count);
    for (int i = 0; i < count; ++i) {
        const BayContent content = i == open_bay         ? BayContent::shelves
                                   : builder.chance(0.5) ? BayContent::drawers
                                                         : BayContent::door;
        add_bay(builder, bay_area(front, i, count), content, style, 2);
    }
    add_plate(builder, style.carcass, plate, 0.003);
}

void build_shelf(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    FrontStyle style;
    style.thickness = 0.0;
    style.setback = 0.0;
    style.carcass = choose_wood(builder);
    const int count = bays_for(builder.width(), 0.85);
    for (int i = 0; i < count; ++i) {
        add_bay(builder, bay_area(front_area(builder, 0.0, builder.height()), i, count),
                BayContent::shelves, style);
    }
}

void build_wall_shelf(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double thickness = std::min(0.03, builder.height());
    builder.top(choose_wood(builder), {-x, -y, 0.0}, {x, y, thickness});
    const std::uint32_t things = builder.clutter(Material::paper);
    for (double at = -y + 0.03; at < y - 0.12; at += builder.pick(0.06, 0.4)) {
        const double width = builder.pick(0.02, 0.09);
        const double top = thickness + builder.pick(0.08, 0.24);
        builder.box(things, {-x + 0.01, at, thickness + 0.0005}, {0.6 * x, at + width, top});
        at += width;
    }
}

}  // namespace roomscribe
