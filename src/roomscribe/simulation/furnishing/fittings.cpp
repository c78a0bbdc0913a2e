// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Four bars around a panel that lies `recess` behind them.
void add_framed_panel(ItemBuilder& builder, Material frame, Material panel, double bar,
                      double recess) {
    builder.begin(Label::unknown, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t frame_part = builder.part(frame);
    builder.box(builder.part(panel), {-x, -y + 0.5 * bar, 0.5 * bar},
                {x - recess, y - 0.5 * bar, h - 0.5 * bar});
    builder.box(frame_part, {-x + 0.0005, -y, 0.0}, {x, -y + bar, h});
    builder.box(frame_part, {-x + 0.0005, y - bar, 0.0}, {x, y, h});
    builder.box(frame_part, {-x + 0.0005, -y, 0.0}, {x, y, bar});
    builder.box(frame_part, {-x + 0.0005, -y, h - bar}, {x, y, h});
}

void add_valve(ItemBuilder& builder, double side) {
    const std::uint32_t part = builder.part(Material::metal);
    const double y = side * (builder.width() / 2.0 + 0.025);
    builder.cylinder(part, {0.0, side * (builder.width() / 2.0 - 0.01), 0.05}, {0.0, y, 0.05},
                     0.012, 8);
    builder.cylinder(part, {0.0, y, 0.062}, {0.0, y, -builder.item().elevation}, 0.009, 8);
    if (side > 0.0) {
        builder.cylinder(builder.part(Material::paint), {0.0, y, 0.05}, {0.0, y, 0.12}, 0.02, 12);
    }
}

/// Two flat sheets with a grille above.
void add_panel_radiator(ItemBuilder& builder) {
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t part = builder.part(Material::paint);
    builder.box(part, {x - 0.012, -y, 0.0}, {x, y, h - 0.01});
    builder.box(part, {-x, -y, 0.0}, {-x + 0.012, y, h - 0.01});
    if (builder.depth() > 0.07) {
        builder.box(part, {-x, -y - 0.001, 0.02}, {x - 0.002, -y + 0.004, h});
        builder.box(part, {-x, y - 0.004, 0.02}, {x - 0.002, y + 0.001, h});
        const int num_slats = static_cast<int>(builder.width() / 0.03);
        for (int i = 0; i < num_slats; ++i) {
            const double at = -y + (i + 0.5) * builder.width() / num_slats;
            builder.box(part, {-x + 0.002, at - 0.006, h - 0.014},
                        {x - 0.003, at + 0.006, h - 0.002});
        }
    } else {
        builder.box(part, {-x + 0.011, -y + 0.02, 0.03}, {x - 0.011, y - 0.02, h - 0.04});
    }
}

/// Upright sections side by side.
void add_sectional_radiator(ItemBuilder& builder) {
    const double x = builder.depth() / 2.0;
    const double h = builder.height();
    const std::uint32_t part = builder.part(Material::paint);
    const int num_sections = std::max(2, static_cast<int>(builder.width() / 0.06));
    const double pitch = builder.width() / num_sections;
    for (int i = 0; i < num_sections; ++i) {
        const double y = -builder.width() / 2.0 + (i + 0.5) * pitch;
        const double radius = std::min(0.02, 0.4 * pitch);
        builder.cylinder(part, {x - radius, y, 0.02}, {x - radius, y, h - 0.02}, radius, 8);
        builder.cylinder(part, {-x + radius, y, 0.02}, {-x + radius, y, h - 0.02}, radius, 8);
        builder.box(part, {-x, y - 0.46 * pitch, 0.0}, {x, y + 0.46 * pitch, 0.05});
        builder.box(part, {-x, y - 0.46 * pitch, h - 0.05}, {x, y + 0.46 * pitch, h});
    }
    const double y = builder.width() / 2.0;
    builder.cylinder(part, {0.0, -y, 0.026}, {0.0, y, 0.026}, 0.02, 8);
    builder.cylinder(part, {0.0, -y, h - 0.026}, {0.0, y, h - 0.026}, 0.02, 8);
}

}  // namespace

void build_picture(ItemBuilder& builder) {
    constexpr std::array frames{Material::wood, Material::dark_wood, Material::black_plastic,
                                Material::metal};
    if (builder.chance(0.25)) {  // canvas without a frame
        builder.begin(Label::unknown, builder.item().kind);
        builder.box(builder.part(Material::fabric),
                    {-builder.depth() / 2.0, -builder.width() / 2.0, 0.0},
                    {builder.depth() / 2.0, builder.width() / 2.0, builder.height()});
        return;
    }
    const Material frame = frames[static_cast<std::size_t>(builder.choose(4))];
    const Material panel = builder.chance(0.3) ? Material::tile : Material::paper;
    const double border = std::min(builder.pick(0.015, 0.05), 0.2 * builder.width());
    add_framed_panel(builder, frame, panel, border, 0.5 * builder.depth());
}

void build_whiteboard(ItemBuilder& builder) {
    add_framed_panel(builder, Material::metal, Material::lacquer, 0.018, 0.4 * builder.depth());
    const double x = builder.depth() / 2.0;
    const double y = std::min(0.3, 0.4 * builder.width());
    builder.box(builder.part(Material::metal), {x - 0.01, -y, 0.002}, {x + 0.07, y, 0.014});
    builder.box(builder.clutter(Material::black_plastic), {x + 0.02, -0.1, 0.0145},
                {x + 0.04, 0.06, 0.032});
}

void build_notice_board(ItemBuilder& builder) {
    add_framed_panel(builder, Material::wood, Material::fabric, 0.02, 0.4 * builder.depth());
    const double panel = 0.1 * builder.depth();
    const std::uint32_t note = builder.clutter(Material::paper);
    const double y = builder.width() / 2.0 - 0.2;
    const double h = builder.height() - 0.36;
    if (y < 0.05 || h < 0.05) return;
    for (int i = 0; i < 4; ++i) {
        const Vector3d at{panel + 0.0004 * (i + 1), builder.pick(-y, y),
                          0.04 + builder.pick(0.0, h)};
        const Transform pose = moved_and_turned(at, Vector3d::UnitX(), builder.pick(-0.1, 0.1));
        builder.quad(note,
                     {pose * Vector3d(0.0, -0.105, 0.0), pose * Vector3d(0.0, 0.105, 0.0),
                      pose * Vector3d(0.0, 0.105, 0.297), pose * Vector3d(0.0, -0.105, 0.297)});
    }
}

void build_mirror(ItemBuilder& builder) {
    const Material frame = builder.chance(0.5) ? Material::wood : Material::metal;
    const double border = builder.pick(0.01, 0.05);
    add_framed_panel(builder, frame, Material::mirror, border, 0.3 * builder.depth());
}

void build_tv_screen(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t body = builder.part(Material::black_plastic);
    const double back = std::max(-x, x - 0.045);
    builder.box(body, {back, -y, 0.0}, {x - 0.004, y, h});
    builder.box(body, {-x, -0.3 * y, 0.2 * h}, {back + 0.001, 0.3 * y, 0.7 * h});
    builder.box(builder.part(Material::screen), {x - 0.02, -y + 0.008, 0.012},
                {x, y - 0.008, h - 0.008});
}

void build_radiator(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    if (builder.chance(0.7)) {
        add_panel_radiator(builder);
    } else {
        add_sectional_radiator(builder);
    }
    add_valve(builder, 1.0);
    add_valve(builder, -1.0);
}

void build_curtain(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const std::uint32_t cloth = builder.part(Material::fabric);
    const double x = builder.depth() / 2.0 - 0.01;
    const double y = builder.width() / 2.0;
    const double top = builder.height() - 0.03;
    const int num_folds = std::max(3, static_cast<int>(builder.width() / 0.045));
    std::vector<double> swing;
    for (int i = 0; i <= num_folds; ++i)
        swing.push_back((i % 2 == 0 ? -1.0 : 1.0) * x * builder.pick(0.6, 1.0));
    for (int i = 0; i < num_folds; ++i) {
        const auto fold = static_cast<std::size_t>(i);
        const double y0 = -y + builder.width() * i / num_folds;
        const double y1 = -y + builder.width() * (i + 1) / num_folds;
        builder.quad(cloth, {Vector3d(swing[fold], y0, 0.0), Vector3d(swing[fold + 1], y1, 0.0),
                             Vector3d(0.7 * swing[fold + 1], y1, top),
                             Vector3d(0.7 * swing[fold], y0, top)});
    }
    builder.cylinder(builder.part(Material::metal), {0.0, -y, top + 0.015}, {0.0, y, top + 0.015},
                     0.012, 10);
}

void build_coat_rack(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    builder.box(builder.part(Material::wood), {-x, -y, h - 0.1}, {-x + 0.02, y, h});
    const int num_hooks = std::max(2, static_cast<int>(builder.width() / 0.15));
    for (int i = 0; i < num_hooks; ++i) {
        const double at = -y + (i + 0.5) * builder.width() / num_hooks;
        builder.cylinder(builder.part(Material::metal), {-x + 0.01, at, h - 0.06},
                         {-x + 0.09, at, h - 0.03}, 0.007, 6);
        if (!builder.chance(0.5)) continue;
        const double length = std::min(builder.pick(0.6, 1.1), h - 0.06);
        const double middle = h - 0.05 - 0.5 * length;
        builder.ellipsoid(builder.part(Material::fabric), {0.2 * x, at, middle},
                          {0.75 * x, 0.1, 0.5 * length}, 12);
    }
}

void build_clock(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double radius = builder.width() / 2.0;
    builder.cylinder(builder.part(Material::black_plastic), {-x, 0.0, radius}, {x, 0.0, radius},
                     radius, 28);
    builder.cylinder(builder.part(Material::paper), {0.0, 0.0, radius}, {x + 0.002, 0.0, radius},
                     0.9 * radius, 28);
}

void build_fire_extinguisher(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    const double h = builder.height();
    builder.cylinder(builder.part(Material::lacquer), {0.0, 0.0, 0.0}, {0.0, 0.0, 0.78 * h}, radius,
                     16);
    builder.ellipsoid(builder.part(Material::lacquer), {0.0, 0.0, 0.78 * h},
                      {0.97 * radius, 0.97 * radius, 0.1 * h}, 14);
    builder.cylinder(builder.part(Material::black_plastic), {0.0, 0.0, 0.8 * h}, {0.0, 0.0, h},
                     0.3 * radius, 8);
}

void build_switch_plate(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    const std::uint32_t part = builder.part(Material::lacquer);
    builder.box(part, {-x, -y, 0.0}, {0.4 * x, y, h});
    builder.box(part, {-x, -0.7 * y, 0.15 * h}, {x, 0.7 * y, 0.85 * h});
}

void build_ceiling_lamp(ItemBuilder& builder) {
    builder.begin(Label::unknown, "lamp");
    const double h = builder.height();
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    if (std::abs(x - y) < 0.005 && builder.chance(0.5)) {
        builder.cylinder(builder.part(Material::lacquer), {0.0, 0.0, 0.0}, {0.0, 0.0, h}, x, 28);
        return;
    }
    builder.box(builder.part(Material::metal), {-x, -y, 0.012}, {x, y, h});
    builder.box(builder.part(Material::lacquer), {-x + 0.015, -y + 0.015, 0.0},
                {x - 0.015, y - 0.015, 0.013});
}

void build_pendant_lamp(ItemBuilder& builder) {
    builder.begin(Label::unknown, "lamp");
    const double h = builder.height();
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    builder.cylinder(builder.part(Material::black_plastic), {0.0, 0.0, 0.1}, {0.0, 0.0, h - 0.02},
                     0.004, 6);
    builder.cylinder(builder.part(Material::lacquer), {0.0, 0.0, h - 0.03}, {0.0, 0.0, h}, 0.05,
                     14);
    const double shade = std::min(0.8 * radius, 0.45 * h);
    builder.ellipsoid(builder.part(Material::paper), {0.0, 0.0, shade}, {radius, radius, shade},
                      18);
}

void build_smoke_detector(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    const double radius = builder.width() / 2.0;
    const double h = builder.height();
    builder.cylinder(builder.part(Material::lacquer), {0.0, 0.0, 0.4 * h}, {0.0, 0.0, h}, radius,
                     20);
    builder.cylinder(builder.part(Material::lacquer), {0.0, 0.0, 0.0}, {0.0, 0.0, 0.41 * h},
                     0.75 * radius, 20);
}

void build_rug(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind, label_bit(Label::floor));
    builder.box(builder.part(Material::carpet),
                {-builder.depth() / 2.0, -builder.width() / 2.0, 0.0},
                {builder.depth() / 2.0, builder.width() / 2.0, builder.height()});
}

}  // namespace roomscribe
