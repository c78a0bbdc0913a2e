// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/furnishing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

/// Usual sizes of a kind, in steps as they are sold; a step of 0 is any size between.
struct Range {
    double low = 0.0;
    double high = 0.0;
    double step = 0.0;

    double draw(Random& random) const {
        const double value = random.uniform(low, high);
        if (step == 0.0) return std::round(value * 1000.0) / 1000.0;
        return std::clamp(low + std::round((value - low) / step) * step, low, high);
    }
};

struct ItemKind {
    std::string_view name;
    Range depth;
    Range width;
    Range height;
    Range elevation;  ///< of what hangs on a wall and whose plan does not say
    void (*build)(ItemBuilder& builder);
};

constexpr Range on_floor{};

// Sources: docs/simulation.md.
constexpr std::array kinds{
    // Storage.
    ItemKind{"cabinet", {0.35, 0.5, 0.05}, {0.6, 1.8, 0.1}, {0.7, 1.2}, on_floor, build_cabinet},
    ItemKind{"wardrobe", {0.55, 0.65}, {0.8, 2.4, 0.1}, {1.9, 2.4}, on_floor, build_wardrobe},
    ItemKind{"office_cupboard",
             {0.4, 0.5},
             {0.8, 1.2, 0.2},
             {1.6, 2.0},
             on_floor,
             build_office_cupboard},
    ItemKind{"drawer_unit", {0.45, 0.6}, {0.4, 0.48}, {0.55, 1.3}, on_floor, build_drawer_unit},
    ItemKind{"chest_of_drawers",
             {0.4, 0.5},
             {0.7, 1.2, 0.1},
             {0.75, 1.1},
             on_floor,
             build_chest_of_drawers},
    ItemKind{"nightstand", {0.35, 0.45}, {0.4, 0.5}, {0.45, 0.6}, on_floor, build_nightstand},
    ItemKind{"tv_unit", {0.35, 0.48}, {1.2, 2.0, 0.2}, {0.4, 0.58}, on_floor, build_tv_unit},
    ItemKind{"shelf", {0.25, 0.4}, {0.6, 1.6, 0.2}, {1.5, 2.2}, on_floor, build_shelf},
    ItemKind{"wall_shelf", {0.2, 0.3}, {0.6, 1.2, 0.2}, {0.02, 0.03}, {1.3, 1.7}, build_wall_shelf},
    // Kitchen and bath.
    ItemKind{
        "kitchen_base", {0.6, 0.63}, {1.2, 3.6, 0.3}, {0.86, 0.92}, on_floor, build_kitchen_base},
    ItemKind{"wall_unit", {0.3, 0.37}, {0.6, 3.0, 0.3}, {0.6, 0.9}, {1.35, 1.5}, build_wall_unit},
    ItemKind{"tall_unit", {0.58, 0.6}, {0.6, 0.6}, {2.0, 2.3}, on_floor, build_tall_unit},
    ItemKind{"fridge", {0.6, 0.68}, {0.55, 0.7}, {1.4, 2.0}, on_floor, build_fridge},
    ItemKind{"vanity", {0.45, 0.5}, {0.6, 1.2, 0.2}, {0.8, 0.88}, on_floor, build_vanity},
    ItemKind{
        "washing_machine", {0.5, 0.6}, {0.6, 0.6}, {0.85, 0.85}, on_floor, build_washing_machine},
    ItemKind{"toilet", {0.62, 0.7}, {0.36, 0.4}, {0.75, 0.82}, on_floor, build_toilet},
    ItemKind{"bathtub", {0.7, 0.8}, {1.5, 1.8, 0.1}, {0.5, 0.6}, on_floor, build_bathtub},
    // Tables.
    ItemKind{"desk", {0.6, 0.8, 0.1}, {1.2, 1.8, 0.2}, {0.72, 0.76}, on_floor, build_desk},
    ItemKind{"table", {0.75, 1.0, 0.05}, {1.1, 2.0, 0.1}, {0.72, 0.76}, on_floor, build_table},
    ItemKind{
        "round_table", {0.8, 1.2, 0.1}, {0.8, 1.2, 0.1}, {0.72, 0.76}, on_floor, build_round_table},
    ItemKind{"coffee_table", {0.5, 0.75}, {0.8, 1.2}, {0.35, 0.48}, on_floor, build_coffee_table},
    ItemKind{"counter", {0.7, 0.9}, {1.6, 3.0, 0.2}, {1.05, 1.15}, on_floor, build_counter},
    // Seats and beds.
    ItemKind{"chair", {0.48, 0.56}, {0.42, 0.5}, {0.8, 0.95}, on_floor, build_chair},
    ItemKind{
        "occupied_chair", {0.48, 0.56}, {0.42, 0.5}, {0.8, 0.95}, on_floor, build_occupied_chair},
    ItemKind{"office_chair", {0.64, 0.7}, {0.64, 0.7}, {0.92, 1.15}, on_floor, build_office_chair},
    ItemKind{"stool", {0.32, 0.4}, {0.32, 0.4}, {0.43, 0.5}, on_floor, build_stool},
    ItemKind{"bench", {0.35, 0.45}, {1.0, 1.8, 0.1}, {0.43, 0.47}, on_floor, build_bench},
    ItemKind{"armchair", {0.75, 0.95}, {0.75, 0.95}, {0.75, 1.0}, on_floor, build_armchair},
    ItemKind{"sofa", {0.85, 1.0}, {1.5, 2.3}, {0.75, 0.9}, on_floor, build_sofa},
    ItemKind{"bed", {2.02, 2.12}, {0.9, 1.8, 0.3}, {0.8, 1.1}, on_floor, build_bed},
    // What stands and lies about.
    ItemKind{"box", {0.2, 0.5}, {0.25, 0.6}, {0.15, 0.5}, on_floor, build_box},
    ItemKind{"bag", {0.15, 0.3}, {0.3, 0.45}, {0.3, 0.5}, on_floor, build_bag},
    ItemKind{"ball", {0.22, 0.22}, {0.22, 0.22}, {0.22, 0.22}, on_floor, build_ball},
    ItemKind{"bin", {0.22, 0.32}, {0.22, 0.32}, {0.28, 0.6}, on_floor, build_bin},
    ItemKind{"papers", {0.24, 0.34}, {0.3, 0.4}, {0.004, 0.06}, on_floor, build_papers},
    ItemKind{"books", {0.16, 0.26}, {0.1, 0.5}, {0.2, 0.32}, on_floor, build_books},
    ItemKind{"monitor", {0.18, 0.24}, {0.5, 0.72}, {0.42, 0.56}, on_floor, build_monitor},
    ItemKind{"keyboard", {0.13, 0.16}, {0.5, 0.6}, {0.015, 0.03}, on_floor, build_keyboard},
    ItemKind{"laptop", {0.3, 0.36}, {0.3, 0.38}, {0.21, 0.26}, on_floor, build_laptop},
    ItemKind{"kettle", {0.2, 0.24}, {0.2, 0.24}, {0.22, 0.28}, on_floor, build_kettle},
    ItemKind{"microwave", {0.32, 0.4}, {0.45, 0.52}, {0.26, 0.3}, on_floor, build_microwave},
    ItemKind{"dishes", {0.2, 0.28}, {0.35, 0.5}, {0.08, 0.14}, on_floor, build_dishes},
    ItemKind{"bottle", {0.065, 0.09}, {0.065, 0.09}, {0.2, 0.33}, on_floor, build_bottle},
    ItemKind{"plant", {0.4, 0.9}, {0.4, 0.9}, {0.5, 1.7}, on_floor, build_plant},
    ItemKind{"person", {0.32, 0.36}, {0.46, 0.56}, {1.55, 1.92}, on_floor, build_person},
    ItemKind{"floor_lamp", {0.32, 0.45}, {0.32, 0.45}, {1.4, 1.8}, on_floor, build_floor_lamp},
    ItemKind{"desk_lamp", {0.35, 0.45}, {0.15, 0.16}, {0.4, 0.52}, on_floor, build_desk_lamp},
    // On walls.
    ItemKind{"picture", {0.015, 0.04}, {0.3, 1.3}, {0.3, 0.9}, {1.2, 1.5}, build_picture},
    ItemKind{"whiteboard",
             {0.018, 0.03},
             {0.9, 1.8, 0.3},
             {0.9, 1.2, 0.3},
             {0.85, 0.95},
             build_whiteboard},
    ItemKind{"notice_board",
             {0.015, 0.025},
             {0.6, 1.2, 0.3},
             {0.6, 0.9, 0.3},
             {1.1, 1.3},
             build_notice_board},
    ItemKind{"mirror", {0.01, 0.03}, {0.4, 0.9}, {0.6, 1.6}, {0.3, 1.0}, build_mirror},
    ItemKind{"tv_screen", {0.06, 0.12}, {0.9, 1.5}, {0.52, 0.86}, {1.0, 1.3}, build_tv_screen},
    ItemKind{
        "radiator", {0.05, 0.12}, {0.6, 2.0, 0.1}, {0.3, 0.6, 0.1}, {0.1, 0.15}, build_radiator},
    ItemKind{"curtain", {0.08, 0.14}, {0.25, 0.6}, {2.1, 2.4}, {0.02, 0.04}, build_curtain},
    ItemKind{"coat_rack", {0.22, 0.3}, {0.6, 1.2}, {1.2, 1.2}, {0.6, 0.6}, build_coat_rack},
    ItemKind{"clock", {0.03, 0.05}, {0.25, 0.35}, {0.25, 0.35}, {1.9, 2.1}, build_clock},
    ItemKind{"fire_extinguisher",
             {0.15, 0.19},
             {0.15, 0.19},
             {0.5, 0.6},
             {0.5, 0.7},
             build_fire_extinguisher},
    ItemKind{"switch_plate",
             {0.01, 0.014},
             {0.08, 0.081},
             {0.08, 0.081},
             {1.0, 1.1},
             build_switch_plate},
    ItemKind{"socket_plate",
             {0.01, 0.014},
             {0.08, 0.153, 0.073},
             {0.08, 0.081},
             {0.26, 0.45},
             build_switch_plate},
    // Under ceilings: their plan must say how high.
    ItemKind{"ceiling_lamp",
             {0.3, 0.6, 0.3},
             {0.6, 1.2, 0.3},
             {0.05, 0.1},
             on_floor,
             build_ceiling_lamp},
    ItemKind{"pendant_lamp", {0.25, 0.5}, {0.25, 0.5}, {0.6, 1.2}, on_floor, build_pendant_lamp},
    ItemKind{
        "smoke_detector", {0.1, 0.12}, {0.1, 0.12}, {0.035, 0.055}, on_floor, build_smoke_detector},
    ItemKind{"rug", {1.2, 2.0}, {1.6, 2.9}, {0.008, 0.015}, on_floor, build_rug},
    // Parts of the building.
    ItemKind{"column", {0.25, 0.5, 0.05}, {0.25, 0.5, 0.05}, {2.6, 2.6}, on_floor, build_column},
    ItemKind{"round_column",
             {0.25, 0.5, 0.05},
             {0.25, 0.5, 0.05},
             {2.6, 2.6},
             on_floor,
             build_round_column},
    ItemKind{"beam", {0.2, 0.4}, {3.0, 6.0}, {0.2, 0.45}, {2.2, 2.2}, build_beam},
    ItemKind{"soffit", {0.5, 1.5}, {2.0, 4.0}, {0.2, 0.4}, {2.3, 2.3}, build_soffit},
    ItemKind{"pipe", {0.05, 0.11}, {0.05, 0.11}, {2.5, 2.5}, on_floor, build_pipe},
};

constexpr auto names = [] {
    std::array<std::string_view, kinds.size()> list;
    for (std::size_t i = 0; i < kinds.size(); ++i)
        list[i] = kinds[i].name;
    return list;
}();

const ItemKind& kind_of(const ItemPlan& item) {
    const auto* kind = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const ItemKind& k) { return k.name == item.kind; });
    if (kind == kinds.end()) {
        throw InvalidArgument("item.kind", item.kind,
                              fmt::format("one of {}", fmt::join(names, ", ")));
    }
    return *kind;
}

}  // namespace

std::span<const std::string_view> item_kinds() {
    return names;
}

ItemPlan resolve_item(const ItemPlan& item) {
    const ItemKind& kind = kind_of(item);
    if (!item.size.allFinite() || item.size.minCoeff() < 0.0) {
        throw InvalidArgument(
            "item.size", fmt::format("{} x {} x {} m", item.size.x(), item.size.y(), item.size.z()),
            "finite and not negative (0 takes a usual size)");
    }
    if (!item.at.allFinite() || !std::isfinite(item.turn) || !std::isfinite(item.elevation)) {
        throw InvalidArgument("item.at", item.kind, "a finite position, turn and elevation");
    }
    // All are drawn, so that one size that is given does not change the others.
    Random random(item.style, 1);
    const Eigen::Vector3d usual{kind.depth.draw(random), kind.width.draw(random),
                                kind.height.draw(random)};
    const double usual_elevation = kind.elevation.draw(random);
    ItemPlan resolved = item;
    for (int axis = 0; axis < 3; ++axis) {
        if (resolved.size[axis] == 0.0) resolved.size[axis] = usual[axis];
    }
    if (resolved.elevation == 0.0) resolved.elevation = usual_elevation;
    return resolved;
}

void add_item(SimulatedWorld& world, const ItemPlan& item) {
    ItemBuilder builder(world, resolve_item(item));
    kind_of(item).build(builder);
    builder.finish();
}

std::vector<Eigen::AlignedBox3d> measure_item(const ItemPlan& item) {
    SimulatedWorld world;
    ItemBuilder builder(world, resolve_item(item));
    kind_of(item).build(builder);
    builder.finish();
    return builder.shapes();
}

}  // namespace roomscribe
