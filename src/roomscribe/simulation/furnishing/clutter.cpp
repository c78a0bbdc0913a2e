// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

Transform turned(const Vector3d& at, double angle) {
    return moved_and_turned(at, Vector3d::UnitZ(), radians(angle));
}

}  // namespace

void build_box(ItemBuilder& builder) {
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t part = builder.clutter(Material::paper);
    if (builder.chance(0.7)) {
        builder.box(part, {-x, -y, 0.0}, {x, y, h});
        return;
    }
    // Open above, its flaps up.
    builder.box(part, {-x, -y, 0.0}, {x, y, 0.01});
    for (const double side : {-1.0, 1.0}) {
        builder.box(part, {side * (x - 0.0025) - 0.0025, -y, 0.0},
                    {side * (x - 0.0025) + 0.0025, y, h});
        builder.box(part, {-x, side * (y - 0.0025) - 0.0025, 0.0},
                    {x, side * (y - 0.0025) + 0.0025, h});
    }
}

void build_bag(ItemBuilder& builder) {
    const std::uint32_t part = builder.clutter(Material::fabric);
    const double h = builder.height();
    builder.ellipsoid(part, {0.0, 0.0, 0.42 * h},
                      {0.5 * builder.depth(), 0.5 * builder.width(), 0.42 * h}, 14);
    const double y = 0.2 * builder.width();
    builder.cylinder(part, {0.0, -y, 0.75 * h}, {0.0, 0.0, 0.99 * h}, 0.01, 6);
    builder.cylinder(part, {0.0, y, 0.75 * h}, {0.0, 0.0, 0.99 * h}, 0.01, 6);
}

void build_ball(ItemBuilder& builder) {
    const double radius = builder.height() / 2.0;
    builder.ellipsoid(builder.clutter(Material::lacquer), {0.0, 0.0, radius},
                      {radius, radius, radius}, 20);
}

void build_bin(ItemBuilder& builder) {
    const std::uint32_t part =
        builder.clutter(builder.chance(0.5) ? Material::black_plastic : Material::metal);
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    constexpr int sides = 16;
    builder.cylinder(part, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.01}, 0.85 * radius, sides);
    for (int i = 0; i < sides; ++i) {
        const auto rim = [&](int step, double share, double z) {
            const double angle = 2.0 * std::numbers::pi * step / sides;
            return Vector3d(share * radius * std::cos(angle), share * radius * std::sin(angle), z);
        };
        builder.quad(part, {rim(i, 0.85, 0.001), rim(i + 1, 0.85, 0.001),
                            rim(i + 1, 1.0, builder.height()), rim(i, 1.0, builder.height())});
    }
}

void build_papers(ItemBuilder& builder) {
    const std::uint32_t part = builder.clutter(Material::paper);
    const double h = builder.height();
    // The lower half square to the rest, the upper half pushed out of line.
    const double x = 0.42 * builder.depth();
    const double y = 0.42 * builder.width();
    builder.box(part, {-x, -y, 0.0}, {x, y, 0.6 * h});
    builder.box(part, turned(Vector3d::Zero(), builder.pick(-6.0, 6.0)), {-x, -y, 0.59 * h},
                {x, y, h});
}

void build_books(ItemBuilder& builder) {
    const std::uint32_t part = builder.clutter(Material::paper);
    const double x = builder.depth() / 2.0;
    double y = -builder.width() / 2.0;
    while (y < builder.width() / 2.0 - 0.01) {
        const double width = std::min(builder.pick(0.015, 0.06), builder.width() / 2.0 - y);
        builder.box(part, {-x, y, 0.0},
                    {x * builder.pick(0.6, 1.0), y + width - 0.001,
                     builder.height() * builder.pick(0.75, 1.0)});
        y += width;
    }
}

void build_monitor(ItemBuilder& builder) {
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t frame = builder.clutter(Material::black_plastic);
    const double low = 0.3 * h;
    builder.box(frame, {-x, -0.13, 0.0}, {x, 0.13, 0.012});
    builder.box(frame, {-0.5 * x - 0.02, -0.03, 0.011}, {-0.5 * x, 0.03, 0.7 * h});
    const Transform pose = moved_and_turned({0.0, 0.0, low}, Vector3d::UnitY(), -radians(4.0));
    builder.box(frame, pose, {-0.5 * x - 0.001, -y, 0.0}, {0.01, y, h - low});
    builder.box(builder.clutter(Material::screen), pose, {0.005, -y + 0.012, 0.02},
                {0.012, y - 0.012, h - low - 0.012});
}

void build_keyboard(ItemBuilder& builder) {
    const std::uint32_t part = builder.clutter(Material::black_plastic);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    builder.box(part, {-x, -y, 0.0}, {x, 0.72 * y, builder.height()});
    builder.ellipsoid(part, {0.2 * x, 0.88 * y, 0.017}, {0.05, 0.03, 0.017}, 10);
}

void build_laptop(ItemBuilder& builder) {
    const std::uint32_t part = builder.clutter(Material::metal);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    builder.box(part, {-0.6 * x, -y, 0.0}, {x, y, 0.018});
    const Transform lid =
        moved_and_turned({-0.6 * x, 0.0, 0.014}, Vector3d::UnitY(), -radians(18.0));
    const double rise = builder.height() - 0.016;
    builder.box(part, lid, {-0.008, -y, 0.0}, {0.0, y, rise});
    builder.box(builder.clutter(Material::screen), lid, {-0.004, -y + 0.01, 0.02},
                {0.0015, y - 0.01, rise - 0.01});
}

void build_kettle(ItemBuilder& builder) {
    const std::uint32_t body =
        builder.clutter(builder.chance(0.5) ? Material::chrome : Material::black_plastic);
    const double h = builder.height();
    const double radius = 0.36 * std::min(builder.depth(), builder.width());
    builder.cylinder(body, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.8 * h}, radius, 16);
    builder.ellipsoid(body, {0.0, 0.0, 0.8 * h}, {0.9 * radius, 0.9 * radius, 0.2 * h}, 14);
    const std::uint32_t grip = builder.clutter(Material::black_plastic);
    const double reach = radius + 0.035;
    builder.cylinder(grip, {-0.9 * radius, 0.0, 0.75 * h}, {-reach, 0.0, 0.7 * h}, 0.011, 8);
    builder.cylinder(grip, {-reach, 0.0, 0.71 * h}, {-reach, 0.0, 0.25 * h}, 0.011, 8);
    builder.cylinder(body, {0.8 * radius, 0.0, 0.55 * h}, {radius + 0.03, 0.0, 0.72 * h}, 0.015, 8);
}

void build_microwave(ItemBuilder& builder) {
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    builder.box(builder.clutter(Material::metal), {-x, -y, 0.0}, {x - 0.02, y, h});
    builder.box(builder.clutter(Material::screen), {x - 0.021, -0.4 * y, 0.012},
                {x, y - 0.005, h - 0.005});
    builder.box(builder.clutter(Material::black_plastic), {x - 0.021, -y + 0.005, 0.012},
                {x - 0.004, -0.42 * y, h - 0.005});
}

void build_dishes(ItemBuilder& builder) {
    const std::uint32_t part = builder.clutter(Material::tile);
    const double radius = 0.25 * builder.width();
    const double z = 0.6 * builder.height();
    builder.cylinder(part, {0.0, -0.22 * builder.width(), 0.0}, {0.0, -0.22 * builder.width(), z},
                     radius, 20);
    for (int i = 0; i < 2; ++i) {
        const double y = builder.width() * (0.2 + 0.2 * i);
        builder.cylinder(part, {0.02, y, 0.0}, {0.02, y, builder.height()}, 0.04, 14);
    }
}

void build_bottle(ItemBuilder& builder) {
    const std::uint32_t part =
        builder.clutter(builder.chance(0.5) ? Material::lacquer : Material::black_plastic);
    const double radius = builder.width() / 2.0;
    const double h = builder.height();
    builder.cylinder(part, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.65 * h}, radius, 12);
    builder.ellipsoid(part, {0.0, 0.0, 0.65 * h}, {0.95 * radius, 0.95 * radius, 0.1 * h}, 12);
    builder.cylinder(part, {0.0, 0.0, 0.65 * h}, {0.0, 0.0, h}, 0.4 * radius, 10);
}

void build_plant(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    const double h = builder.height();
    const double pot = std::min(0.35 * h, 0.4);
    const std::uint32_t leaf = builder.part(Material::plant);
    builder.cylinder(builder.part(Material::tile), {0.0, 0.0, 0.0}, {0.0, 0.0, pot}, 0.45 * radius,
                     20);
    builder.cylinder(leaf, {0.0, 0.0, pot - 0.01}, {0.0, 0.0, 0.75 * h}, 0.015, 6);
    const int num_leaves = 26;
    for (int i = 0; i < num_leaves; ++i) {
        // Flat leaves at golden-angle steps, each on its own stalk.
        const double angle = radians(137.5 * i);
        const double share = (i + 0.5) / num_leaves;
        const double out =
            radius * builder.pick(0.35, 0.68) * std::sin(std::numbers::pi * (0.15 + 0.7 * share));
        const double z = pot + (h - pot) * (0.15 + 0.75 * share);
        Transform pose = turned({out * std::cos(angle), out * std::sin(angle), z}, degrees(angle));
        pose.rotate(Eigen::AngleAxisd(builder.pick(-0.7, 0.5), Vector3d::UnitY()));
        builder.ellipsoid(leaf, pose, {0.28 * radius, 0.12 * radius, 0.006}, 8);
        builder.cylinder(leaf, {0.0, 0.0, z - 0.12 * h}, pose.translation(), 0.004, 5);
    }
}

void build_person(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const std::uint32_t body = builder.part(Material::fabric);
    const double h = builder.height();
    const double half_width = builder.width() / 2.0;
    // Shares of the body height after Drillis and Contini (1966).
    const double hip = 0.53 * h;
    const double shoulder = 0.818 * h;
    const double stride = builder.pick(-0.1, 0.1);
    for (const double side : {-1.0, 1.0}) {
        const double foot = side * stride;
        const double y = 0.4 * half_width * side;
        builder.cylinder(body, {0.0, y, hip + 0.03}, {0.5 * foot + 0.01, y, 0.285 * h}, 0.08, 10);
        builder.cylinder(body, {0.5 * foot + 0.01, y, 0.3 * h}, {foot, y, 0.05}, 0.055, 10);
        builder.box(body, {foot - 0.07, y - 0.045, 0.0}, {foot + 0.17, y + 0.045, 0.075});
        const double arm = (half_width - 0.055) * side;
        builder.cylinder(body, {0.0, arm, shoulder - 0.02}, {-0.5 * foot, arm, 0.63 * h}, 0.05, 8);
        builder.cylinder(body, {-0.5 * foot, arm, 0.64 * h}, {0.07 - 0.5 * foot, arm, 0.48 * h},
                         0.04, 8);
    }
    builder.ellipsoid(body, {0.0, 0.0, (hip + shoulder) / 2.0},
                      {0.125, 0.8 * half_width, 0.62 * (shoulder - hip)}, 14);
    builder.cylinder(body, {0.0, 0.0, shoulder - 0.02}, {0.01, 0.0, 0.88 * h}, 0.055, 8);
    builder.ellipsoid(body, {0.015, 0.0, 0.935 * h}, {0.1, 0.08, 0.066 * h}, 14);
}

void build_floor_lamp(ItemBuilder& builder) {
    builder.begin(Label::unknown, "lamp");
    const double h = builder.height();
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    const std::uint32_t metal = builder.part(Material::metal);
    builder.cylinder(metal, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.025}, 0.75 * radius, 20);
    builder.cylinder(metal, {0.0, 0.0, 0.02}, {0.0, 0.0, h - 0.05}, 0.012, 8);
    builder.cylinder(builder.part(Material::fabric), {0.0, 0.0, h - 0.28}, {0.0, 0.0, h}, radius,
                     20);
}

void build_desk_lamp(ItemBuilder& builder) {
    builder.begin(Label::unknown, "lamp");
    const std::uint32_t metal = builder.part(Material::metal);
    const double h = builder.height();
    const double x = builder.depth() / 2.0;
    builder.cylinder(metal, {-x + 0.07, 0.0, 0.0}, {-x + 0.07, 0.0, 0.02}, 0.07, 16);
    builder.cylinder(metal, {-x + 0.07, 0.0, 0.01}, {-x + 0.03, 0.0, 0.55 * h}, 0.008, 6);
    builder.cylinder(metal, {-x + 0.03, 0.0, 0.55 * h}, {x - 0.1, 0.0, h - 0.01}, 0.008, 6);
    builder.cylinder(metal, {x - 0.11, 0.0, h - 0.01}, {x - 0.06, 0.0, h - 0.13}, 0.055, 14);
}

}  // namespace roomscribe
