// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/furniture_groups.hpp"

#include <algorithm>
#include <cstdint>

namespace roomscribe {
namespace {

/// Things on a desk, a chair before it, now and then somebody at work.
void add_workplace_things(Furnisher& f, const ItemPlan& desk) {
    const double back = -desk.size.x() / 2.0;
    if (f.chance(0.75)) {
        const double y = f.pick(-0.2, 0.2);
        const ItemPlan monitor = f.make("monitor");
        if (f.put_on(desk, monitor, back + 0.16, y, f.pick(-8.0, 8.0))) {
            const ItemPlan keyboard = f.make("keyboard");
            f.put_on(desk, keyboard, back + 0.42, y, f.pick(-5.0, 5.0));
        }
        if (desk.size.y() > 1.5 && f.chance(0.4)) {
            const ItemPlan second = f.make("monitor");
            f.put_on(desk, second, back + 0.18, y + (y > 0.0 ? -0.7 : 0.7), f.pick(-15.0, 15.0));
        }
    } else {
        const ItemPlan laptop = f.make("laptop");
        const double y = f.pick(-0.2, 0.2);
        f.put_on(desk, laptop, 0.0, y, f.pick(-10.0, 10.0));
    }
    f.strew_on(desk, {"papers", "papers", "bottle", "books", "desk_lamp"}, f.count(0, 4));
    const ItemPlan chair = f.make(f.chance(0.8) ? "office_chair" : "chair");
    for (int attempt = 0; attempt < 5; ++attempt) {
        const double x = desk.size.x() / 2.0 + chair.size.x() / 2.0 + f.pick(-0.3, 0.2);
        const double y = f.pick(-0.25, 0.25);
        if (f.place_by(desk, chair, x, y, 180.0 + f.pick(-50.0, 50.0), anywhere)) break;
    }
}

}  // namespace

std::optional<ItemPlan> place_near_wall(Furnisher& f, const ItemPlan& item,
                                        const Demands& demands) {
    if (auto placed = f.place_along_wall(item, demands)) return placed;
    return f.place_along_wall(item, demands, 0.22);
}

void add_desk(Furnisher& f) {
    const ItemPlan desk = f.make("desk");
    const Demands demands{.front_space = 0.0, .avoids_windows = false};
    std::optional<ItemPlan> placed;
    const double lot = f.pick(0.0, 1.0);
    if (lot < 0.55) {
        placed = place_near_wall(f, desk, demands);
    } else if (lot < 0.85) {
        placed = f.place_in_the_middle(desk, demands);
    } else {
        placed = f.place_freely(desk, demands);
    }
    if (!placed) return;
    // Now and then a second one faces it.
    if (lot >= 0.55 && f.chance(0.5)) {
        const ItemPlan other = f.make("desk", {0.0, desk.size.y(), desk.size.z()});
        const double x = -(desk.size.x() + other.size.x()) / 2.0 - 0.01;
        if (const auto facing = f.place_by(*placed, other, x, 0.0, 180.0, demands)) {
            add_workplace_things(f, *facing);
        }
    }
    add_workplace_things(f, *placed);
}

void add_chairs(Furnisher& f, const ItemPlan& table, double share) {
    const double length = table.size.y();
    const int per_side = std::max(1, static_cast<int>(length / 0.62));
    const std::uint64_t set = f.make("chair").style;
    const auto seat = [&](double x, double y, double turn) {
        if (!f.chance(share)) return;
        const ItemPlan chair =
            f.chance(0.1) ? f.make("chair")
                          : f.make_of_style(f.chance(0.06) ? "occupied_chair" : "chair", set);
        const double turned = turn + (f.chance(0.25) ? f.pick(-35.0, 35.0) : f.pick(-5.0, 5.0));
        // Pushed under the table where nothing else will do.
        for (const double most : {0.25, 0.0, -0.1}) {
            const double out = chair.size.x() / 2.0 + f.pick(most - 0.2, most);
            if (f.place_by(table, chair,
                           x + (x > 0.0   ? out
                                : x < 0.0 ? -out
                                          : 0.0),
                           y + (x != 0.0  ? 0.0
                                : y > 0.0 ? out
                                          : -out),
                           turned, anywhere)) {
                break;
            }
        }
    };
    for (int i = 0; i < per_side; ++i) {
        const double y = length * ((i + 0.5) / per_side - 0.5);
        seat(table.size.x() / 2.0, y, 180.0);
        seat(-table.size.x() / 2.0, y, 0.0);
    }
    if (f.chance(0.5)) seat(0.0, length / 2.0, -90.0);
    if (f.chance(0.5)) seat(0.0, -length / 2.0, 90.0);
}

}  // namespace roomscribe
