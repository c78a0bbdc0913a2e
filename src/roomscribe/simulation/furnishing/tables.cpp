// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "roomscribe/simulation/furnishing/furniture_fronts.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

Material choose_top(ItemBuilder& builder) {
    constexpr std::array tops{Material::wood, Material::wood, Material::dark_wood,
                              Material::lacquer};
    return tops[static_cast<std::size_t>(builder.choose(4))];
}

/// Four square or round legs under a plate whose underside is at `height`.
void add_legs(ItemBuilder& builder, Material material, double thickness, double inset,
              double height, bool are_round) {
    const std::uint32_t part = builder.part(material);
    const double half = thickness / 2.0;
    const double x = builder.depth() / 2.0 - inset - half;
    const double y = builder.width() / 2.0 - inset - half;
    for (const double i : {-1.0, 1.0}) {
        for (const double j : {-1.0, 1.0}) {
            if (are_round) {
                builder.cylinder(part, {i * x, j * y, 0.0}, {i * x, j * y, height + 0.001}, half);
            } else {
                builder.box(part, {i * x - half, j * y - half, 0.0},
                            {i * x + half, j * y + half, height + 0.001});
            }
        }
    }
}

/// Rails between the legs, below the plate.
void add_apron(ItemBuilder& builder, Material material, double inset, double top) {
    const std::uint32_t part = builder.part(material);
    const double x = builder.depth() / 2.0 - inset;
    const double y = builder.width() / 2.0 - inset;
    const double low = top - 0.08;
    for (const double side : {-1.0, 1.0}) {
        builder.box(part, {-x, side * y - 0.01, low}, {x, side * y + 0.01, top + 0.001});
        builder.box(part, {side * x - 0.01, -y, low}, {side * x + 0.01, y, top + 0.001});
    }
}

/// Two columns on feet that run from back to front, as height-adjustable desks have.
void add_t_legs(ItemBuilder& builder, double height) {
    const std::uint32_t part = builder.part(Material::metal);
    const double x = builder.depth() / 2.0 - 0.06;
    const double y = builder.width() / 2.0 - 0.14;
    for (const double side : {-1.0, 1.0}) {
        builder.box(part, {-x, side * y - 0.035, 0.0}, {x, side * y + 0.035, 0.03});
        builder.box(part, {-0.05, side * y - 0.03, 0.029}, {0.05, side * y + 0.03, height + 0.001});
    }
    builder.box(part, {-0.03, -y, height - 0.05}, {0.03, y, height + 0.0005});
}

void add_side_panels(ItemBuilder& builder, Material material, double height) {
    const std::uint32_t part = builder.part(material);
    const double x = builder.depth() / 2.0 - 0.01;
    const double y = builder.width() / 2.0;
    for (const double side : {-1.0, 1.0}) {
        builder.box(part, {-x, side * (y - 0.0125) - 0.0125, 0.0},
                    {x, side * (y - 0.0125) + 0.0125, height - 0.0005});
    }
}

/// A unit of drawers below a desk's plate, at its left or right.
void add_pedestal(ItemBuilder& builder, Material material, double height) {
    FrontStyle style = choose_front_style(builder.random(), material);
    style.back_space = 0.15;
    const double side = builder.chance(0.5) ? 1.0 : -1.0;
    const double y = side * (builder.width() / 2.0 - 0.28);
    const double front = builder.depth() / 2.0 - 0.04;
    const FaceArea area{front, {y - 0.21, 0.06}, {y + 0.21, height - 0.03}};
    add_bay(builder, area, BayContent::drawers, style, 3);
    builder.box(builder.part(style.carcass),
                {-builder.depth() / 2.0 + style.back_space + 0.02, y - 0.19, 0.0},
                {front - 0.06, y + 0.19, 0.061});
}

void add_plate(ItemBuilder& builder, Material material, double thickness) {
    builder.top(material,
                {-builder.depth() / 2.0, -builder.width() / 2.0, builder.height() - thickness},
                {builder.depth() / 2.0, builder.width() / 2.0, builder.height()});
}

/// A round plate with a face of as many corners as its edge.
void add_round_plate(ItemBuilder& builder, Material material, double thickness) {
    constexpr int sides = 32;
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    const double top = builder.height();
    std::vector<Vector3d> rim;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        rim.emplace_back(radius * std::cos(angle), radius * std::sin(angle), top);
    }
    const std::uint32_t part = builder.part_of(builder.add_face("top", rim), material);
    const Vector3d middle(0.0, 0.0, top);
    const Vector3d down(0.0, 0.0, -thickness);
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const Vector3d& a = rim[i];
        const Vector3d& b = rim[(i + 1) % rim.size()];
        builder.quad(part, {a, b, b + down, a + down});
        // Two triangles of the plate at a time: the middle, this corner and its neighbours.
        if (i % 2 != 0) continue;
        const Vector3d& before = rim[(i + rim.size() - 1) % rim.size()];
        builder.quad(part, {middle, before, a, b});
        builder.quad(part, {middle + down, before + down, a + down, b + down});
    }
}

}  // namespace

void build_desk(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const Material top = choose_top(builder);
    const double plate = builder.pick(0.022, 0.03);
    const double below = builder.height() - plate;
    double leg = 0.0;
    switch (builder.choose(3)) {
        case 0:
            add_t_legs(builder, below);
            break;
        case 1:
            leg = builder.pick(0.04, 0.06);
            add_legs(builder, Material::metal, leg, 0.01, below, builder.chance(0.3));
            break;
        default:
            add_side_panels(builder, top, below);
    }
    if (builder.chance(0.4)) {
        builder.box(builder.part(top),
                    {-builder.depth() / 2.0 + 0.06, -builder.width() / 2.0 + 0.03, 0.35},
                    {-builder.depth() / 2.0 + 0.078, builder.width() / 2.0 - 0.03, below - 0.01});
    }
    if (builder.chance(0.4) && builder.width() > 1.1) add_pedestal(builder, top, below);
    add_plate(builder, top, plate);
}

void build_table(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const Material top = choose_top(builder);
    const double plate = builder.pick(0.02, 0.04);
    const double below = builder.height() - plate;
    const bool is_metal = builder.chance(0.3);
    const double leg = is_metal ? 0.04 : builder.pick(0.05, 0.08);
    add_legs(builder, is_metal ? Material::metal : top, leg, 0.02, below, builder.chance(0.3));
    if (!is_metal) add_apron(builder, top, 0.02 + leg / 2.0, below);
    add_plate(builder, top, plate);
}

void build_round_table(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double plate = builder.pick(0.02, 0.03);
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    const std::uint32_t foot = builder.part(Material::metal);
    builder.cylinder(foot, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.02}, 0.6 * radius, 24);
    builder.cylinder(foot, {0.0, 0.0, 0.019}, {0.0, 0.0, builder.height() - plate + 0.001}, 0.04);
    add_round_plate(builder, choose_top(builder), plate);
}

void build_coffee_table(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const Material top = choose_top(builder);
    const double plate = builder.pick(0.018, 0.04);
    const double below = builder.height() - plate;
    add_legs(builder, top, 0.045, 0.02, below, builder.chance(0.4));
    if (builder.chance(0.5)) {
        builder.box(builder.part(top),
                    {-builder.depth() / 2.0 + 0.03, -builder.width() / 2.0 + 0.03, 0.12},
                    {builder.depth() / 2.0 - 0.03, builder.width() / 2.0 - 0.03, 0.136});
    }
    add_plate(builder, top, plate);
}

void build_counter(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const Material body = choose_top(builder);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t part = builder.part(body);
    // The visitor's side, the two ends, and behind them the lower plate to work at.
    builder.box(part, {x - 0.06, -y, 0.0}, {x - 0.02, y, h - 0.03});
    for (const double side : {-1.0, 1.0}) {
        builder.box(part, {-x + 0.02, side * (y - 0.015) - 0.015, 0.0},
                    {x - 0.03, side * (y - 0.015) + 0.015, 0.739});
    }
    builder.top(Material::wood, {-x, -y + 0.001, 0.71}, {x - 0.061, y - 0.001, 0.74});
    builder.top(body, {x - 0.3, -y - 0.01, h - 0.031}, {x, y + 0.01, h});
}

}  // namespace roomscribe
