// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// A frame at a place, leaning back by an angle in degrees.
Transform leaning(const Vector3d& at, double angle) {
    return moved_and_turned(at, Vector3d::UnitY(), -radians(angle));
}

double seat_height(ItemBuilder& builder) {
    return std::min(builder.pick(0.43, 0.47), 0.6 * builder.height());
}

/// Seat, legs and back of a chair; returns the height of its seat.
double add_chair(ItemBuilder& builder) {
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double seat = seat_height(builder);
    const bool is_metal = builder.chance(0.4);
    const Material frame = is_metal ? Material::metal : Material::wood;
    const Material pad = builder.chance(0.5)       ? Material::fabric
                         : frame == Material::wood ? Material::wood
                                                   : Material::black_plastic;
    const double leg = is_metal ? 0.012 : builder.pick(0.016, 0.02);
    const std::uint32_t frame_part = builder.part(frame);
    const double back_x = -x + 0.06;
    // The lowest point of a leg that stands aslant is its rim.
    const double tip = 0.002;
    for (const double side : {-1.0, 1.0}) {
        const double leg_y = side * (y - leg);
        builder.cylinder(frame_part, {x - leg, leg_y, tip}, {x - leg - 0.02, leg_y, seat - 0.01},
                         leg, 8);
        builder.cylinder(frame_part, {-x + leg, leg_y, tip}, {back_x, leg_y, seat}, leg, 8);
        builder.cylinder(frame_part, {back_x, leg_y, seat - 0.02},
                         {-x + leg, leg_y, builder.height() - leg}, leg, 8);
    }
    builder.box(builder.part(pad), {back_x - 0.02, -y + 0.004, seat - 0.035},
                {x - 0.003, y - 0.004, seat});
    const double back_height = builder.height() - 0.01;
    const Transform back = leaning({back_x + 0.002, 0.0, seat}, 4.0);
    const double rise = back_height - seat;
    const double inner = y - 2.0 * leg + 0.004;
    if (builder.chance(0.5)) {
        builder.box(builder.part(pad), back, {-0.014, -inner, 0.35 * rise}, {0.012, inner, rise});
    } else {
        for (const double low : {0.4, 0.62, 0.84}) {
            builder.box(frame_part, back, {-0.008, -inner, low * rise},
                        {0.008, inner, (low + 0.13) * rise});
        }
    }
    return seat;
}

/// Cushioned block with rounded edges on top: sofas, armchairs.
void add_cushion(ItemBuilder& builder, std::uint32_t part, const Vector3d& low,
                 const Vector3d& high) {
    const Vector3d middle = (low + high) / 2.0;
    builder.box(part, low, {high.x(), high.y(), high.z() - 0.02});
    builder.ellipsoid(part, {middle.x(), middle.y(), high.z() - 0.03},
                      {0.48 * (high.x() - low.x()), 0.48 * (high.y() - low.y()), 0.03}, 16);
}

void build_upholstered(ItemBuilder& builder, int num_seats) {
    builder.begin(Label::furniture, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const std::uint32_t fabric = builder.part(Material::fabric);
    const double seat = std::min(builder.pick(0.4, 0.45), 0.6 * builder.height());
    const double arm = builder.pick(0.12, 0.2);
    const double arm_top = std::min(builder.pick(0.55, 0.65), builder.height() - 0.1);
    const double back = builder.pick(0.2, 0.26);
    const double foot = builder.pick(0.04, 0.13);
    for (const double i : {-1.0, 1.0}) {
        for (const double j : {-1.0, 1.0}) {
            const Vector3d at(i * (x - 0.07), j * (y - 0.07), 0.0);
            builder.cylinder(builder.part(Material::dark_wood), at,
                             at + Vector3d(0.0, 0.0, foot + 0.001), 0.02, 8);
        }
        builder.box(fabric, {-x, i * (y - arm / 2.0) - arm / 2.0, foot},
                    {x, i * (y - arm / 2.0) + arm / 2.0, arm_top});
    }
    builder.box(fabric, {-x, -y + arm, foot}, {x - 0.03, y - arm, seat - 0.13});
    builder.box(fabric, leaning({-x + 0.001, 0.0, seat - 0.14}, 0.0), {0.0, -y + arm - 0.001, 0.0},
                {back - 0.05, y - arm + 0.001, builder.height() - seat + 0.14});
    const double pitch = 2.0 * (y - arm) / num_seats;
    for (int i = 0; i < num_seats; ++i) {
        const double low = -y + arm + i * pitch + 0.003;
        const double high = low + pitch - 0.006;
        add_cushion(builder, fabric, {-x + back - 0.06, low, seat - 0.14}, {x - 0.01, high, seat});
        const Transform pose = leaning({-x + back + 0.08, (low + high) / 2.0, seat - 0.01}, 12.0);
        builder.box(fabric, pose, {-0.1, (low - high) / 2.0, 0.0},
                    {0.05, (high - low) / 2.0, 0.92 * (builder.height() - seat)});
    }
    if (!builder.chance(0.6)) return;
    const std::uint32_t pillow = builder.clutter(Material::fabric);
    const double side = builder.chance(0.5) ? 1.0 : -1.0;
    builder.ellipsoid(pillow,
                      leaning({-x + back + 0.22, side * (y - arm - 0.24), seat + 0.2}, 25.0),
                      {0.07, 0.21, 0.2});
}

}  // namespace

void build_chair(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    add_chair(builder);
}

void build_occupied_chair(ItemBuilder& builder) {
    builder.begin(Label::furniture, "chair");
    const double seat = add_chair(builder);
    add_sitting_person(builder, seat, -builder.depth() / 2.0 + 0.1);
}

void build_office_chair(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double reach = std::min(builder.depth(), builder.width()) / 2.0 - 0.03;
    const double seat = builder.pick(0.46, 0.52);
    const std::uint32_t frame =
        builder.part(builder.chance(0.5) ? Material::black_plastic : Material::metal);
    const std::uint32_t castor = builder.part(Material::black_plastic);
    for (int i = 0; i < 5; ++i) {
        const double angle = radians(72.0 * i + 36.0);
        const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
        builder.cylinder(frame, Vector3d(0.0, 0.0, 0.12), reach * out + Vector3d(0.0, 0.0, 0.075),
                         0.02, 8);
        const Vector3d axle(-out.y(), out.x(), 0.0);
        const Vector3d hub = reach * out + Vector3d(0.0, 0.0, 0.03);
        builder.cylinder(castor, hub - 0.02 * axle, hub + 0.02 * axle, 0.03, 12);
    }
    builder.cylinder(frame, {0.0, 0.0, 0.08}, {0.0, 0.0, 0.3}, 0.035);
    builder.cylinder(builder.part(Material::chrome), {0.0, 0.0, 0.29}, {0.0, 0.0, seat - 0.05},
                     0.02);
    const Material cover = builder.chance(0.7) ? Material::fabric : Material::black_plastic;
    const std::uint32_t pad = builder.part(cover);
    builder.box(castor, {-0.14, -0.12, seat - 0.09}, {0.14, 0.12, seat - 0.05});
    builder.box(pad, {-0.2, -0.22, seat - 0.06}, {0.22, 0.22, seat - 0.015});
    builder.ellipsoid(pad, {0.0, 0.0, seat - 0.03}, {0.24, 0.245, 0.03}, 16);

    const double low = seat + builder.pick(0.04, 0.12);
    const double rise = builder.height() - low - 0.01;
    const Transform back = leaning({-0.24, 0.0, low}, builder.pick(5.0, 12.0));
    for (int i = -2; i <= 2; ++i) {
        // Five strips make the back hollow.
        const double bend = 0.012 * i * i;
        builder.box(pad, back, {bend - 0.02, 0.09 * i - 0.0455, 0.0},
                    {bend + 0.02, 0.09 * i + 0.0455, rise});
    }
    builder.box(castor, leaning({-0.27, 0.0, seat - 0.09}, 6.0), {-0.015, -0.035, 0.0},
                {0.005, 0.035, 0.4});
    builder.box(castor, {-0.28, -0.035, seat - 0.09}, {-0.12, 0.035, seat - 0.07});
    if (!builder.chance(0.6)) return;
    for (const double side : {-1.0, 1.0}) {
        const double y = side * std::min(0.26, builder.width() / 2.0 - 0.04);
        builder.box(castor, {-0.03, y - 0.012, seat - 0.08}, {0.03, y + 0.012, seat + 0.19});
        builder.box(castor, {-0.12, y - 0.035, seat + 0.19}, {0.13, y + 0.035, seat + 0.215});
        builder.box(castor, {-0.02, std::min(y, 0.1 * side), seat - 0.08},
                    {0.02, std::max(y, 0.1 * side), seat - 0.065});
    }
}

void build_stool(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    const double h = builder.height();
    builder.cylinder(builder.part(builder.chance(0.5) ? Material::wood : Material::fabric),
                     {0.0, 0.0, h - 0.035}, {0.0, 0.0, h}, radius, 24);
    for (int i = 0; i < 4; ++i) {
        const double angle = radians(90.0 * i + 45.0);
        const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
        builder.cylinder(builder.part(Material::wood),
                         (radius - 0.02) * out + Vector3d(0.0, 0.0, 0.002),
                         0.7 * radius * out + Vector3d(0.0, 0.0, h - 0.034), 0.015, 8);
    }
}

void build_bench(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    for (const double side : {-1.0, 1.0}) {
        builder.box(builder.part(Material::metal), {-x + 0.03, side * (y - 0.15) - 0.025, 0.0},
                    {x - 0.03, side * (y - 0.15) + 0.025, builder.height() - 0.034});
    }
    builder.top(Material::wood, {-x, -y, builder.height() - 0.035}, {x, y, builder.height()});
}

void build_armchair(ItemBuilder& builder) {
    build_upholstered(builder, 1);
}

void build_sofa(ItemBuilder& builder) {
    build_upholstered(builder, builder.width() > 1.85 ? 3 : 2);
}

void build_bed(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double frame_top = builder.pick(0.26, 0.34);
    const double mattress_top = frame_top + builder.pick(0.16, 0.24);
    const Material wood = builder.chance(0.5) ? Material::wood : Material::dark_wood;
    const std::uint32_t frame = builder.part(wood);
    const std::uint32_t cloth = builder.part(Material::fabric);
    builder.box(frame, {-x, -y, 0.0}, {-x + 0.05, y, builder.height()});
    builder.box(frame, {-x + 0.049, -y, 0.1}, {x, y, frame_top});
    for (const double side : {-1.0, 1.0})
        builder.box(frame, {x - 0.1, side * (y - 0.05) - 0.04, 0.0},
                    {x - 0.02, side * (y - 0.05) + 0.04, 0.101});
    builder.box(cloth, {-x + 0.06, -y + 0.03, frame_top - 0.05},
                {x - 0.03, y - 0.03, mattress_top});
    // A duvet that hangs over both sides, thrown back a little.
    const double duvet = -x + builder.pick(0.55, 0.9);
    builder.box(cloth, {duvet, -y + 0.01, mattress_top - 0.1},
                {x - 0.02, y - 0.01, mattress_top + builder.pick(0.04, 0.08)});
    builder.ellipsoid(cloth, {(duvet + x) / 2.0, builder.pick(-0.1, 0.1), mattress_top + 0.05},
                      {0.4 * (x - duvet), 0.35 * builder.width(), 0.07}, 16);
    const int num_pillows = builder.width() > 1.25 ? 2 : 1;
    for (int i = 0; i < num_pillows; ++i) {
        const double at = num_pillows == 1 ? 0.0 : (i - 0.5) * y;
        builder.ellipsoid(cloth, leaning({-x + 0.3, at, mattress_top + 0.07}, 10.0),
                          {0.2, std::min(0.36, 0.42 * builder.width()), 0.09}, 16);
    }
}

void add_sitting_person(ItemBuilder& builder, double seat_height, double back) {
    builder.begin(Label::unknown, "person");
    const std::uint32_t body = builder.part(Material::fabric);
    const double hip_x = back + 0.13;
    const double hip_z = seat_height + 0.09;
    const double knee_x = std::min(hip_x + 0.42, builder.depth() / 2.0 + 0.1);
    for (const double side : {-1.0, 1.0}) {
        const double y = 0.1 * side;
        builder.cylinder(body, {hip_x, y, hip_z}, {knee_x, y, hip_z}, 0.075, 10);
        builder.cylinder(body, {knee_x, y, hip_z + 0.02}, {knee_x + 0.02, y, 0.06}, 0.055, 10);
        builder.box(body, {knee_x - 0.06, y - 0.045, 0.0}, {knee_x + 0.17, y + 0.045, 0.08});
        builder.cylinder(body, {hip_x + 0.02, 0.21 * side, hip_z + 0.42},
                         {hip_x + 0.1, 0.24 * side, hip_z + 0.14}, 0.045, 8);
        builder.cylinder(body, {hip_x + 0.09, 0.24 * side, hip_z + 0.15},
                         {hip_x + 0.34, 0.14 * side, hip_z + 0.17}, 0.038, 8);
    }
    builder.ellipsoid(body, {hip_x + 0.01, 0.0, hip_z + 0.24}, {0.115, 0.2, 0.34}, 14);
    builder.ellipsoid(body, {hip_x + 0.04, 0.0, hip_z + 0.68}, {0.095, 0.08, 0.12}, 14);
    builder.cylinder(body, {hip_x + 0.02, 0.0, hip_z + 0.5}, {hip_x + 0.03, 0.0, hip_z + 0.62},
                     0.055, 8);
}

}  // namespace roomscribe
