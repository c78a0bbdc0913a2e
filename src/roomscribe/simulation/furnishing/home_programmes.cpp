// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include "roomscribe/simulation/furnishing/furniture_groups.hpp"

namespace roomscribe {
namespace {

/// The longest run of base units that fits a wall, most often with room for a fridge beside it.
std::optional<ItemPlan> add_kitchen_run(Furnisher& f, double longest) {
    const double beside = f.chance(0.7) ? 0.75 : 0.0;
    const double height = f.make("kitchen_base").size.z();
    const double gap = f.pick(0.016, 0.025);
    for (double length = longest; length > 1.1; length -= 0.3) {
        const ItemPlan base = f.make("kitchen_base", {0.0, length, height});
        for (int attempt = 0; attempt < 4; ++attempt) {
            for (std::size_t wall = 0; wall < f.floor().walls().size(); ++wall) {
                const double room = f.floor().walls()[wall].length() - length - 0.02;
                if (room < beside) continue;
                const double along =
                    0.01 + length / 2.0 + room * (attempt < 2 ? attempt : f.pick(0.0, 1.0));
                auto placed = f.place_at_wall(base, wall, along, gap, {.front_space = 0.85});
                if (placed) return placed;
            }
        }
    }
    return std::nullopt;
}

void furnish_run(Furnisher& f, const ItemPlan& run, double density) {
    const double back = -run.size.x() / 2.0;
    bool has_tall = false;
    for (const double side : {-1.0, 1.0}) {
        if (!f.chance(0.75)) continue;
        const ItemPlan tall = f.make_of_style(f.chance(0.6) ? "fridge" : "tall_unit", run.style);
        const double y = side * (run.size.y() / 2.0 + tall.size.y() / 2.0 + 0.012);
        if (f.place_by(run, tall, back + tall.size.x() / 2.0 + 0.01, y, 0.0, with_doors)) {
            has_tall = true;
        }
    }
    if (!has_tall) f.place_along_wall(f.make("fridge"), with_doors);
    ItemPlan upper = f.make_of_style("wall_unit", run.style);
    for (double length = run.size.y(); length > 0.55 && f.chance(0.97); length -= 0.3) {
        upper.size.y() = length;
        const double room = run.size.y() - length;
        if (f.place_by(run, upper, back + upper.size.x() / 2.0, f.pick(-0.5, 0.5) * room, 0.0)) {
            break;
        }
    }
    f.strew_on(run, {"kettle", "microwave", "dishes", "dishes", "bottle", "box"},
               f.count(1, 2 + static_cast<int>(5.0 * density)));
}

}  // namespace

void furnish_kitchen(Furnisher& f, double density) {
    if (const auto run = add_kitchen_run(f, 3.6)) furnish_run(f, *run, density);
    if (f.chance(0.3 + 0.4 * density)) {
        if (const auto run = add_kitchen_run(f, 2.1)) furnish_run(f, *run, density);
    }
    const char* kind = f.chance(0.3) ? "round_table" : "table";
    const ItemPlan table = f.make(kind, {f.pick(0.7, 0.9), f.pick(0.9, 1.4), 0.0});
    auto placed = f.place_in_the_middle(table, anywhere);
    if (!placed) placed = f.place_along_wall(table, anywhere);
    if (placed) {
        add_chairs(f, *placed, 0.8);
        f.strew_on(*placed, {"dishes", "bottle", "papers"}, f.count(0, 3));
    }
    f.place_along_wall(f.make("bin"), anywhere);
    if (f.chance(0.4)) f.hang(f.make("clock"));
    if (f.chance(0.3)) f.hang(f.make("wall_shelf"));
}

void furnish_living(Furnisher& f, double density) {
    auto sofa = f.chance(0.3) ? f.place_in_the_middle(f.make("sofa"), anywhere) : std::nullopt;
    if (!sofa) {
        sofa = place_near_wall(f, f.make("sofa"), {.front_space = 0.3, .avoids_windows = false});
    }
    if (sofa) {
        if (f.chance(0.6)) f.place_by(*sofa, f.make("rug"), 1.3, 0.0, 0.0);
        const ItemPlan table = f.make("coffee_table");
        const double x = (sofa->size.x() + table.size.x()) / 2.0 + f.pick(0.32, 0.5);
        const double y = f.pick(-0.2, 0.2);
        if (const auto low = f.place_by(*sofa, table, x, y, f.pick(-4.0, 4.0), anywhere)) {
            f.strew_on(*low, {"papers", "books", "bottle", "dishes"}, f.count(0, 3));
        }
        if (f.chance(0.6)) {
            const double side = f.chance(0.5) ? 1.0 : -1.0;
            const ItemPlan armchair = f.make("armchair");
            const double ahead = f.pick(1.2, 1.8);
            const double aside = side * (sofa->size.y() / 2.0 + f.pick(0.2, 0.6));
            f.place_by(*sofa, armchair, ahead, aside, -side * f.pick(60.0, 130.0), anywhere);
        }
    }
    if (const auto unit = f.place_along_wall(f.make("tv_unit"), {.front_space = 0.5})) {
        if (f.chance(0.8)) {
            ItemPlan screen = f.make("tv_screen");
            const double x = f.pick(-0.08, 0.05);
            const double y = f.pick(-0.1, 0.1);
            f.put_on(*unit, screen, x, y, f.pick(-4.0, 4.0));
        }
    }
    const int storage =
        std::clamp(static_cast<int>(f.floor().area() * (0.3 + density) / 7.0), 0, 5);
    for (int i = 0; i < storage; ++i)
        f.place_along_wall(f.make(f.one_of({"shelf", "cabinet", "chest_of_drawers"})), with_doors);
    if (f.floor().area() > 18.0 && f.chance(0.6)) {
        if (const auto table = f.place_freely(f.make("table"), anywhere)) {
            add_chairs(f, *table, 0.9);
            f.strew_on(*table, {"dishes", "papers", "bottle"}, f.count(0, 4));
        }
    }
    if (f.chance(0.6)) f.place_along_wall(f.make("floor_lamp"), anywhere, 0.05);
    if (f.chance(0.4)) f.hang(f.make("wall_shelf"));
}

void furnish_bedroom(Furnisher& f, double density) {
    if (const auto bed = place_near_wall(f, f.make("bed"), anywhere)) {
        for (const double side : {-1.0, 1.0}) {
            if (!f.chance(0.75)) continue;
            const ItemPlan stand = f.make("nightstand");
            const auto placed =
                f.place_by(*bed, stand, -bed->size.x() / 2.0 + stand.size.x() / 2.0 + 0.01,
                           side * (bed->size.y() / 2.0 + stand.size.y() / 2.0 + f.pick(0.02, 0.08)),
                           0.0, anywhere);
            if (placed) f.strew_on(*placed, {"books", "bottle", "desk_lamp"}, f.count(0, 2));
        }
    }
    const int wardrobes = std::clamp(static_cast<int>(f.floor().area() / 12.0), 1, 3);
    for (int i = 0; i < wardrobes; ++i)
        f.place_along_wall(f.make("wardrobe"), with_doors);
    if (f.chance(0.3 + 0.5 * density)) {
        if (const auto chest = f.place_along_wall(f.make("chest_of_drawers"), with_doors)) {
            f.strew_on(*chest, {"books", "bottle", "desk_lamp", "box"}, f.count(0, 3));
        }
    }
    if (f.chance(density)) {
        f.place_along_wall(f.make(f.chance(0.5) ? "wardrobe" : "shelf"), with_doors);
    }
    if (f.chance(0.4 * density + 0.1)) add_desk(f);
    if (f.chance(0.5)) f.hang(f.make("mirror"));
    if (f.chance(0.4)) f.place_freely(f.make("chair"), anywhere);
    if (f.chance(0.3)) f.place_freely(f.make("rug"));
}

void furnish_bath(Furnisher& f, double density) {
    if (const auto vanity = f.place_along_wall(f.make("vanity"), {.front_space = 0.5})) {
        ItemPlan mirror = f.make("mirror", {0.0, f.pick(0.5, vanity->size.y()), f.pick(0.6, 0.9)});
        mirror.elevation = vanity->elevation + f.pick(1.1, 1.25);
        f.place_by(*vanity, mirror, -vanity->size.x() / 2.0 + mirror.size.x() / 2.0, 0.0, 0.0);
    }
    f.place_along_wall(f.make("toilet"), {.front_space = 0.45, .avoids_windows = false});
    if (f.chance(0.7)) f.place_along_wall(f.make("bathtub"), anywhere);
    if (f.chance(0.3 + 0.4 * density)) {
        f.place_along_wall(f.make("washing_machine"), {.front_space = 0.5});
    }
    if (f.chance(density)) f.place_along_wall(f.make("shelf", {0.3, 0.4, 0.0}), with_doors);
}

}  // namespace roomscribe
