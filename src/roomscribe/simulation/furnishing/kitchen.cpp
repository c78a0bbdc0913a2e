// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "roomscribe/simulation/furnishing/furniture_fronts.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr double plinth_setback = 0.05;
constexpr double tall_plinth = 0.1;

/// The same for all pieces of one style, so that a kitchen can have one make of fronts.
FrontStyle kitchen_style(const ItemBuilder& builder) {
    constexpr std::array materials{Material::lacquer, Material::paint, Material::wood,
                                   Material::dark_wood};
    Random random(builder.item().style, 3);
    FrontStyle style = choose_front_style(random, materials[random.below(materials.size())]);
    style.carcass = Material::wood;
    style.has_handles_above = true;
    return style;
}

/// Widths of units that fill a run: modules of 300 to 900 mm, the last one takes the rest.
std::vector<double> divide_run(ItemBuilder& builder, double length) {
    constexpr std::array modules{0.6, 0.6, 0.6, 0.8, 0.9, 0.5, 0.45, 0.4, 0.3};
    std::vector<double> units;
    double rest = length;
    while (rest > 1.2) {
        const double unit = modules[static_cast<std::size_t>(builder.choose(9))];
        if (rest - unit < 0.3) continue;
        units.push_back(unit);
        rest -= unit;
    }
    if (rest > 0.9) {
        units.push_back(rest - 0.45);
        rest = 0.45;
    }
    units.push_back(rest);
    return units;
}

BayContent base_content(ItemBuilder& builder, double width) {
    const double pick = builder.pick(0.0, 1.0);
    if (width > 0.58 && width < 0.62 && pick < 0.15) return BayContent::flap;
    if (pick < 0.4) return BayContent::drawers;
    if (width > 0.62) {
        return pick < 0.75 ? BayContent::double_door : BayContent::drawer_and_double_door;
    }
    return pick < 0.75 ? BayContent::door : BayContent::drawer_and_door;
}

/// Basin let into the worktop (seen as a rim and a steel floor) and its tap.
void add_sink(ItemBuilder& builder, double y, double top) {
    const std::uint32_t steel = builder.clutter(Material::metal);
    const std::uint32_t tap = builder.clutter(Material::chrome);
    constexpr double half_depth = 0.22;
    const double half_width = builder.pick(0.22, 0.28);
    const double rim = top + 0.004;
    builder.box(steel, {-half_depth, y - half_width, top - 0.01},
                {half_depth, y + half_width, top + 0.0015});
    for (const double side : {-1.0, 1.0}) {
        builder.box(steel, {side * half_depth - 0.012, y - half_width - 0.012, top - 0.01},
                    {side * half_depth + 0.012, y + half_width + 0.012, rim});
        builder.box(steel, {-half_depth - 0.012, y + side * half_width - 0.012, top - 0.01},
                    {half_depth + 0.012, y + side * half_width + 0.012, rim});
    }
    const double x = -half_depth - 0.035;
    const double reach = x + builder.pick(0.16, 0.2);
    const double height = top + builder.pick(0.18, 0.3);
    builder.cylinder(tap, {x, y, top - 0.01}, {x, y, height}, 0.014);
    builder.cylinder(tap, {x - 0.012, y, height - 0.005}, {reach, y, height - 0.005}, 0.012);
    builder.cylinder(tap, {reach, y, height}, {reach, y, height - 0.05}, 0.012);
}

void add_hob(ItemBuilder& builder, double y, double top) {
    builder.box(builder.clutter(Material::screen), {-0.25, y - 0.29, top - 0.01},
                {0.25, y + 0.29, top + 0.005});
    if (!builder.chance(0.5)) return;
    const std::uint32_t pot = builder.clutter(Material::metal);
    const double radius = builder.pick(0.09, 0.13);
    builder.cylinder(pot, {0.1, y - 0.13, top + 0.006}, {0.1, y - 0.13, top + 0.006 + radius},
                     radius, 20);
}

/// Numbers of the units with the sink (the first that is wide enough) and the hob above the oven
/// (the last of 600 mm); the number of units where there is none.
std::pair<std::size_t, std::size_t> choose_sink_and_hob(const std::vector<double>& units) {
    std::size_t sink = 0;
    while (sink < units.size() && units[sink] < 0.59)
        ++sink;
    std::size_t hob = units.size();
    for (std::size_t i = sink + 1; i < units.size(); ++i) {
        if (std::abs(units[i] - 0.6) < 0.02) hob = i;
    }
    return {sink, hob};
}

/// Doors of a run of units whose lower sides are open to view: one bay a unit.
void add_units(ItemBuilder& builder, const FaceArea& front, const FrontStyle& style) {
    double y = front.low.x();
    for (const double width : divide_run(builder, front.width())) {
        FaceArea bay = front;
        bay.low.x() = y;
        bay.high.x() = y += width;
        add_bay(builder, bay, width > 0.62 ? BayContent::double_door : BayContent::door, style);
    }
}

}  // namespace

void build_kitchen_base(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    const double plinth = builder.pick(0.1, 0.15);
    const double worktop = builder.pick(0.028, 0.04);
    const double overhang = builder.pick(0.02, 0.04);
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    FrontStyle style = kitchen_style(builder);
    const double front_x = x - overhang;
    builder.box(builder.part(Material::dark_wood), {-x + 0.05, -y, 0.0},
                {front_x - style.thickness - plinth_setback, y, plinth + 0.001});

    const double top = builder.height();
    // Handleless kitchens leave a grip of a good 2 cm under the worktop.
    const double grip = style.handle.shape == HandleShape::none ? 0.022 : 0.003;
    FaceArea front{front_x, {-y, plinth}, {y, top - worktop - grip}};
    if (style.handle.shape == HandleShape::none) {
        builder.box(builder.part(style.carcass), {-x, -y, front.high.y() - 0.001},
                    {front_x - style.thickness - 0.02, y, top - worktop + 0.001});
    }
    std::vector<double> places;
    const std::vector<double> units = divide_run(builder, builder.width());
    const auto [sink_unit, hob_unit] = choose_sink_and_hob(units);
    double at = -y;
    for (std::size_t i = 0; i < units.size(); ++i) {
        FaceArea bay = front;
        bay.low.x() = at;
        bay.high.x() = at += units[i];
        places.push_back((bay.low.x() + bay.high.x()) / 2.0);
        const BayContent content =
            i == hob_unit ? BayContent::oven : base_content(builder, units[i]);
        add_bay(builder, bay, content, style, 2 + builder.choose(3));
    }
    builder.top(builder.chance(0.5) ? Material::tile : Material::wood, {-x, -y, top - worktop},
                {x, y, top});
    // A strip against splashes at the wall.
    builder.box(builder.clutter(Material::tile), {-x + 0.0005, -y, top - 0.001},
                {-x + 0.014, y, top + 0.04});
    if (sink_unit < units.size()) add_sink(builder, places[sink_unit], top);
    if (hob_unit < units.size()) add_hob(builder, places[hob_unit], top);
}

void build_wall_unit(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    FrontStyle style = kitchen_style(builder);
    style.handle_height = HandleHeight::low;
    const double y = builder.width() / 2.0;
    add_units(builder, {builder.depth() / 2.0, {-y, 0.0}, {y, builder.height()}}, style);
}

void build_tall_unit(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    FrontStyle style = kitchen_style(builder);
    style.handle_height = HandleHeight::in_reach;
    style.has_level_door_handles = false;
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    builder.box(builder.part(Material::dark_wood), {-x + 0.05, -y, 0.0},
                {x - style.thickness - plinth_setback, y, tall_plinth + 0.001});
    FaceArea lower{x, {-y, tall_plinth}, {y, builder.height()}};
    FaceArea upper = lower;
    if (builder.chance(0.5) && builder.width() > 0.55) {
        FaceArea oven = lower;
        oven.low.y() = 0.82;
        oven.high.y() = 1.42;
        lower.high.y() = oven.low.y();
        upper.low.y() = oven.high.y();
        add_bay(builder, oven, BayContent::oven, style);
        add_bay(builder, lower, builder.chance(0.5) ? BayContent::drawers : BayContent::door, style,
                2);
    } else {
        lower.high.y() = upper.low.y() = builder.pick(1.2, 1.45);
        add_bay(builder, lower, BayContent::door, style);
    }
    add_bay(builder, upper, BayContent::door, style);
}

void build_fridge(ItemBuilder& builder) {
    builder.begin(Label::furniture, builder.item().kind);
    FrontStyle style;
    style.material = builder.chance(0.5) ? Material::metal : Material::lacquer;
    style.carcass = style.material;
    style.thickness = builder.pick(0.05, 0.07);
    style.gap = 0.008;
    style.setback = 0.008;
    style.ajar_share = 0.03;
    style.handle_height = HandleHeight::in_reach;
    if (builder.chance(0.7)) {
        style.handle = {.shape = HandleShape::bar,
                        .hole_spacing = 0.320,
                        .overhang = 0.03,
                        .diameter = builder.pick(0.014, 0.02),
                        .projection = builder.pick(0.04, 0.055)};
    }
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    builder.box(builder.part(Material::black_plastic), {-x + 0.03, -y + 0.02, 0.0},
                {x - style.thickness - 0.04, y - 0.02, 0.051});
    FaceArea lower{x, {-y, 0.05}, {y, builder.height()}};
    FaceArea upper = lower;
    // A freezer below, above, or none in a small one.
    if (builder.height() > 1.2) {
        lower.high.y() = upper.low.y() =
            builder.height() *
            (builder.chance(0.6) ? builder.pick(0.33, 0.42) : builder.pick(0.68, 0.74));
        add_bay(builder, lower, BayContent::door, style);
    }
    add_bay(builder, upper, BayContent::door, style);
}

}  // namespace roomscribe
