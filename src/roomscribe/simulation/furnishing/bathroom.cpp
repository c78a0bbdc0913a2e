// SPDX-License-Identifier: MIT
#include <cmath>

#include "roomscribe/simulation/furnishing/furniture_fronts.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {

using Eigen::Vector3d;

// Sanitary ware is none of the labels, though nobody would call it wrong to say furniture.
constexpr LabelSet also_furniture = label_bit(Label::furniture);

void build_vanity(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    FrontStyle style = choose_front_style(builder.random(), Material::lacquer);
    style.has_handles_above = true;
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double top = builder.height();
    // Hung on the wall or on a plinth.
    const double base = builder.chance(0.5) ? 0.3 : 0.08;
    if (base < 0.1) {
        builder.box(builder.part(Material::wood), {-x, -y, 0.0}, {x - 0.06, y, base + 0.001});
    }
    const FaceArea front{x - 0.01, {-y + 0.004, base}, {y - 0.004, top - 0.06}};
    add_bay(builder, front, builder.chance(0.5) ? BayContent::drawers : BayContent::double_door,
            style, 2);
    builder.top(Material::tile, {-x, -y, top - 0.0595}, {x, y, top});
    const std::uint32_t basin = builder.clutter(Material::tile);
    const double radius = std::min(0.2, 0.4 * builder.depth());
    builder.cylinder(basin, {0.03, 0.0, top - 0.01}, {0.03, 0.0, top + 0.11}, radius, 24);
    const std::uint32_t tap = builder.clutter(Material::chrome);
    const double tap_x = std::min(0.03 - radius - 0.02, -x + 0.06);
    builder.cylinder(tap, {tap_x, 0.0, top - 0.01}, {tap_x, 0.0, top + 0.22}, 0.015);
    builder.cylinder(tap, {tap_x - 0.01, 0.0, top + 0.21}, {tap_x + 0.16, 0.0, top + 0.21}, 0.013);
}

void build_washing_machine(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t body = builder.part(Material::lacquer);
    builder.box(body, {-x, -y, 0.02}, {x - 0.025, y, h - 0.03});
    builder.box(builder.part(Material::black_plastic), {-x + 0.03, -y + 0.03, 0.0},
                {x - 0.06, y - 0.03, 0.021});
    builder.box(builder.part(Material::black_plastic), {x - 0.03, -y + 0.22, h - 0.13},
                {x - 0.022, y - 0.02, h - 0.05});
    builder.top(Material::lacquer, {-x, -y, h - 0.0295}, {x - 0.02, y, h});
    builder.cylinder(builder.part(Material::chrome), {x - 0.04, 0.0, 0.42}, {x - 0.008, 0.0, 0.42},
                     0.2, 24);
    builder.cylinder(builder.part(Material::screen), {x - 0.04, 0.0, 0.42}, {x, 0.0, 0.42}, 0.15,
                     24);
}

void build_toilet(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind, also_furniture);
    const std::uint32_t part = builder.part(Material::tile);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double seat = std::min(0.41, builder.height());
    builder.box(part, {-x, -y, seat - 0.02}, {-x + 0.18, y, builder.height()});
    builder.box(part, {-x + 0.05, -0.3 * y, 0.0}, {0.3 * x, 0.3 * y, seat - 0.05});
    const double reach = builder.depth() - 0.16;
    builder.ellipsoid(part, {x - reach / 2.0, 0.0, seat - 0.1}, {reach / 2.0, 0.98 * y, 0.1}, 20);
    builder.box(part, {-x + 0.17, -0.85 * y, seat - 0.04}, {0.35 * x, 0.85 * y, seat});
}

void build_bathtub(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind, also_furniture);
    const std::uint32_t part = builder.part(Material::tile);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    constexpr double rim = 0.07;
    builder.box(part, {-x, -y, 0.0}, {-x + rim, y, h});
    builder.box(part, {x - rim, -y, 0.0}, {x, y, h});
    builder.box(part, {-x, -y, 0.0}, {x, -y + rim, h});
    builder.box(part, {-x, y - rim, 0.0}, {x, y, h});
    builder.box(part, {-x, -y, 0.0}, {x, y, 0.14});
    const std::uint32_t tap = builder.clutter(Material::chrome);
    builder.cylinder(tap, {0.0, y - 0.035, h - 0.01}, {0.0, y - 0.035, h + 0.12}, 0.016);
    builder.cylinder(tap, {0.0, y - 0.02, h + 0.11}, {0.0, y - 0.2, h + 0.11}, 0.014);
}

}  // namespace roomscribe
