// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "roomscribe/simulation/furnishing/furniture_groups.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

void furnish_office(Furnisher& f, double density) {
    const double area = f.floor().area();
    const int wanted = std::clamp(static_cast<int>(area * (0.7 + density) / 8.0), 1, 10);
    for (int i = 0; i < wanted; ++i)
        add_desk(f);
    const int storage = std::clamp(static_cast<int>(area * (0.3 + density) / 5.0), 1, 8);
    for (int i = 0; i < storage; ++i) {
        f.place_along_wall(f.make(f.one_of({"office_cupboard", "office_cupboard", "shelf", "shelf",
                                            "cabinet", "drawer_unit", "drawer_unit"})),
                           with_doors);
    }
    if (area > 24.0 && f.chance(0.4)) {
        if (const auto table = f.place_in_the_middle(f.make("round_table"), anywhere)) {
            add_chairs(f, *table, 0.8);
        }
    }
    if (f.chance(0.5)) f.hang(f.make("whiteboard"));
    if (f.chance(0.3)) f.hang(f.make("notice_board"));
    if (f.chance(0.4)) f.hang(f.make("coat_rack"));
    f.place_along_wall(f.make("bin"), anywhere);
}

void furnish_meeting(Furnisher& f, double density) {
    const double area = f.floor().area();
    const double length = std::clamp(0.45 * std::sqrt(area) * f.pick(0.9, 1.5), 1.2, 4.0);
    ItemPlan table = f.make("table", {f.pick(0.9, 1.3), std::round(length * 10.0) / 10.0, 0.0});
    if (const auto placed = f.place_in_the_middle(table, anywhere)) {
        add_chairs(f, *placed, 0.6 + 0.4 * density);
        f.strew_on(*placed, {"papers", "laptop", "bottle", "bottle", "dishes"}, f.count(1, 5));
    }
    f.hang(f.make(f.chance(0.6) ? "tv_screen" : "whiteboard"));
    if (f.chance(0.5)) f.hang(f.make("whiteboard"));
    if (f.chance(0.2 + 0.6 * density)) f.place_along_wall(f.make("cabinet"), with_doors);
    if (f.chance(density)) f.place_along_wall(f.make("shelf"), with_doors);
}

void furnish_corridor(Furnisher& f, double density) {
    const int wanted = std::clamp(static_cast<int>(f.floor().area() * density / 6.0), 0, 6);
    for (int i = 0; i < wanted; ++i) {
        const ItemPlan piece =
            f.make(f.one_of({"cabinet", "bench", "drawer_unit", "office_cupboard", "shelf"}));
        f.place_along_wall(piece, {.front_space = 0.5});
    }
    if (f.chance(0.4)) f.hang(f.make("coat_rack"));
    if (f.chance(0.6)) f.hang(f.make("fire_extinguisher"));
    if (f.chance(0.4)) f.hang(f.make("notice_board"));
    if (f.chance(0.3)) f.place_along_wall(f.make("bin"), anywhere);
    for (int i = f.count(0, 3); i > 0; --i)
        f.hang(f.make("picture"));
}

void furnish_storage(Furnisher& f, double density) {
    const int wanted = 2 + static_cast<int>(f.floor().area() * (0.3 + density) / 3.0);
    for (int i = 0; i < wanted; ++i) {
        f.place_along_wall(f.make(f.one_of({"shelf", "shelf", "shelf", "office_cupboard", "cabinet",
                                            "drawer_unit"})),
                           with_doors);
    }
    for (int i = f.count(2, 5); i > 0; --i) {
        const auto below = f.chance(0.6) ? f.place_along_wall(f.make("box"), anywhere)
                                         : f.place_freely(f.make("box"), anywhere);
        if (below && f.chance(0.4)) f.put_on(*below, f.make("box", {0.2, 0.25, 0.0}), 0.0, 0.0);
    }
}

void furnish_lobby(Furnisher& f, double density) {
    if (f.chance(0.7)) {
        const auto counter = f.place_in_the_middle(f.make("counter"), {.front_space = 0.9});
        if (counter) {
            const ItemPlan chair = f.make("office_chair");
            const double x = -counter->size.x() / 2.0 - 0.5;
            const double y = f.pick(-0.4, 0.4);
            f.place_by(*counter, chair, x, y, f.pick(-30.0, 30.0), anywhere);
        }
    }
    for (int i = f.count(1, 3); i > 0; --i) {
        f.place_along_wall(f.make(f.one_of({"sofa", "armchair", "bench"})),
                           {.front_space = 0.4, .avoids_windows = false});
    }
    if (f.chance(0.6)) f.place_freely(f.make("coffee_table"), anywhere);
    if (f.chance(density)) f.place_along_wall(f.make("cabinet"), with_doors);
    for (int i = f.count(1, 3); i > 0; --i)
        f.place_along_wall(f.make("plant"), anywhere, 0.05);
}

void furnish_mixed(Furnisher& f, double density) {
    if (f.chance(0.6)) add_desk(f);
    const int wanted = 2 + static_cast<int>(f.floor().area() * density / 5.0);
    for (int i = 0; i < wanted; ++i) {
        f.place_along_wall(f.make(f.one_of({"cabinet", "wardrobe", "shelf", "chest_of_drawers",
                                            "office_cupboard", "drawer_unit"})),
                           with_doors);
    }
    if (f.chance(0.6)) {
        if (const auto table = f.place_freely(f.make("table"), anywhere))
            add_chairs(f, *table, 0.8);
    }
}

}  // namespace

void furnish_by_use(Furnisher& furnisher, std::string_view use, double density) {
    if (use == "office") return furnish_office(furnisher, density);
    if (use == "meeting") return furnish_meeting(furnisher, density);
    if (use == "kitchen") return furnish_kitchen(furnisher, density);
    if (use == "corridor" || use == "hall") return furnish_corridor(furnisher, density);
    if (use == "living") return furnish_living(furnisher, density);
    if (use == "bedroom") return furnish_bedroom(furnisher, density);
    if (use == "bath") return furnish_bath(furnisher, density);
    if (use == "storage") return furnish_storage(furnisher, density);
    if (use == "lobby") return furnish_lobby(furnisher, density);
    furnish_mixed(furnisher, density);
}

}  // namespace roomscribe
