// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/furnishing/furnisher.hpp"
#include "roomscribe/simulation/furnishing/furnishing.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

constexpr double seam = 0.001;  // below the ceiling, so that no two surfaces lie in one plane

bool is_any_of(std::string_view use, std::initializer_list<std::string_view> uses) {
    return std::find(uses.begin(), uses.end(), use) != uses.end();
}

double room_height(const RoomPlan& room) {
    return room.ceiling_height - room.floor_height;
}

/// Width of a straight strip across the room before a wall: what a beam can span.
double clear_depth(const RoomFloor& floor, std::size_t wall, double along, double half) {
    return std::min({floor.depth_at(wall, along - half), floor.depth_at(wall, along),
                     floor.depth_at(wall, along + half)});
}

void add_column(Furnisher& f) {
    const double height = room_height(f.floor().room()) - seam;
    const bool is_round = f.chance(0.3);
    ItemPlan column = f.make(is_round ? "round_column" : "column", {0.0, 0.0, height});
    if (is_round) column.size.y() = column.size.x();
    if (f.floor().area() > 20.0 && f.chance(0.5)) {
        f.place_in_the_middle(column);
    } else {
        f.place_along_wall(column, {}, 0.003);
    }
}

/// From a wall straight across to the next.
void add_beam(Furnisher& f) {
    const RoomFloor& floor = f.floor();
    ItemPlan beam = f.make("beam");
    beam.size.z() = std::min(beam.size.z(), room_height(floor.room()) - 2.1);
    if (beam.size.z() < 0.12) return;
    for (int attempt = 0; attempt < 6; ++attempt) {
        const auto wall =
            static_cast<std::size_t>(f.count(0, static_cast<int>(floor.walls().size()) - 1));
        const BuiltWallFace& face = floor.walls()[wall];
        if (face.length() < 1.5) continue;
        const double along = f.pick(0.25, 0.75) * face.length();
        const double span = clear_depth(floor, wall, along, beam.size.x() / 2.0) - 0.006;
        if (!std::isfinite(span) || span < 1.0) continue;
        beam.size.y() = std::floor(span * 1000.0) / 1000.0;
        beam.at = face.start + along * face.along() + (0.003 + span / 2.0) * face.inward();
        const Vector2d front = face.along();
        beam.turn = degrees(std::atan2(front.y(), front.x()));
        beam.elevation = floor.room().ceiling_height - beam.size.z() - seam;
        if (f.place(beam)) return;
    }
}

/// A dropped stretch of ceiling along a whole wall.
void add_soffit(Furnisher& f) {
    const RoomFloor& floor = f.floor();
    ItemPlan soffit = f.make("soffit");
    soffit.size.z() = std::min(soffit.size.z(), room_height(floor.room()) - 2.2);
    if (soffit.size.z() < 0.1) return;
    soffit.elevation = floor.room().ceiling_height - soffit.size.z() - seam;
    for (std::size_t wall = 0; wall < floor.walls().size(); ++wall) {
        soffit.size.y() = floor.walls()[wall].length() - 0.008;
        if (f.place_at_wall(soffit, wall, floor.walls()[wall].length() / 2.0, 0.003)) return;
    }
}

void add_building_parts(Furnisher& f, std::string_view use) {
    const bool is_public = is_any_of(use, {"office", "meeting", "lobby", "corridor", "storage"});
    const double share = is_public ? 0.2 : 0.05;
    if (f.floor().area() > 10.0) {
        for (int i = f.chance(share) ? f.count(1, 2) : 0; i > 0; --i)
            add_column(f);
        if (f.chance(share)) add_beam(f);
    }
    if (f.chance(0.12)) add_soffit(f);
    if (f.chance(0.15)) {
        const ItemPlan pipe = f.make("pipe", {0.0, 0.0, room_height(f.floor().room()) - seam});
        f.place_along_wall(pipe, {}, f.pick(0.01, 0.03));
    }
}

/// Radiators under the windows, curtains beside them.
void add_to_windows(Furnisher& f, std::string_view use) {
    const bool has_curtains = is_any_of(use, {"living", "bedroom"}) && f.chance(0.7);
    const bool has_radiators = f.chance(0.85);
    const double wall_distance = f.pick(0.03, 0.06);
    const ItemPlan type = f.make("radiator");
    const std::vector<OpeningInRoom> openings = f.floor().openings();
    for (const OpeningInRoom& window : openings) {
        if (window.kind != OpeningKind::window) continue;
        const double sill = window.low - f.floor().room().floor_height;
        if (has_radiators && sill > 0.55) {
            ItemPlan radiator = type;
            radiator.size.y() =
                std::max(0.4, std::floor(20.0 * window.half_width * f.pick(0.7, 1.0)) / 10.0);
            radiator.size.z() =
                std::min(radiator.size.z(), std::floor((sill - 0.1 - 0.15) * 10.0) / 10.0);
            f.place_at_wall(radiator, window.wall, window.along, wall_distance);
        }
        if (!has_curtains) continue;
        for (const double side : {-1.0, 1.0}) {
            ItemPlan curtain = f.make("curtain");
            curtain.size.z() = std::min(curtain.size.z(),
                                        room_height(f.floor().room()) - curtain.elevation - 0.05);
            f.place_at_wall(
                curtain, window.wall,
                window.along + side * (window.half_width + curtain.size.y() / 2.0 + 0.05), 0.02);
        }
    }
}

/// Switches beside the doors, sockets along the walls.
void add_plates(Furnisher& f) {
    const std::vector<OpeningInRoom> openings = f.floor().openings();
    for (const OpeningInRoom& door : openings) {
        if (door.kind != OpeningKind::door || !f.chance(0.8)) continue;
        const double side = door.is_latch_at_start ? -1.0 : 1.0;
        const ItemPlan plate = f.make("switch_plate");
        const double along = door.along + side * (door.half_width + f.pick(0.13, 0.2));
        f.place_at_wall(plate, door.wall, along, 0.002, {.avoids_doors = false});
    }
    for (int i = f.count(1, 5); i > 0; --i)
        f.place_along_wall(f.make("socket_plate"), {}, 0.002);
}

/// In a grid as an electrician would; one pendant in rooms where people live.
void add_lamps(Furnisher& f, std::string_view use) {
    const RoomFloor& floor = f.floor();
    const double ceiling = floor.room().ceiling_height;
    const Eigen::AlignedBox2d bounds = bounds_of(floor.room().outline);
    const Vector2d size = bounds.sizes();
    const bool is_home = is_any_of(use, {"living", "bedroom", "kitchen", "hall"});
    ItemPlan lamp = f.make(is_home && f.chance(0.6) ? "pendant_lamp" : "ceiling_lamp");
    if (lamp.kind == "pendant_lamp") {
        lamp.size.z() = std::min(lamp.size.z(), room_height(floor.room()) - 1.9);
    }
    lamp.elevation = ceiling - lamp.size.z() - 2.0 * seam;
    const double pitch = is_home ? 4.5 : f.pick(2.0, 3.0);
    const int columns = std::max(1, static_cast<int>(size.x() / pitch));
    const int rows = std::max(1, static_cast<int>(size.y() / pitch));
    for (int i = 0; i < columns; ++i) {
        for (int j = 0; j < rows; ++j) {
            lamp.at = {bounds.min().x() + (i + 0.5) * size.x() / columns,
                       bounds.min().y() + (j + 0.5) * size.y() / rows};
            f.place(lamp);
        }
    }
    if (!f.chance(0.7)) return;
    ItemPlan detector = f.make("smoke_detector");
    detector.elevation = ceiling - detector.size.z() - 2.0 * seam;
    f.place_in_the_middle(detector);
}

/// Pictures, plants, people, and what lies about.
void add_odds_and_ends(Furnisher& f, std::string_view use, double density) {
    const bool is_bare = is_any_of(use, {"storage", "bath"});
    const double area = f.floor().area();
    for (int i = is_bare ? 0 : f.count(0, 2 + static_cast<int>(area / 8.0)); i > 0; --i) {
        ItemPlan picture = f.make("picture");
        if (f.chance(0.4)) std::swap(picture.size.y(), picture.size.z());
        f.hang(picture);
    }
    if (!is_bare && f.chance(0.2)) f.hang(f.make("clock"));
    if (!is_bare && f.chance(0.1)) f.hang(f.make("mirror"));
    const Demands anywhere{.avoids_windows = false};
    for (int i = is_bare ? 0 : f.count(0, 2); i > 0; --i)
        f.place_along_wall(f.make("plant"), anywhere, 0.05);
    for (int i = f.count(0, 1 + static_cast<int>(area * (0.3 + density) / 3.0)); i > 0; --i) {
        const ItemPlan thing = f.make(f.one_of({"box", "bag", "ball", "bin", "bag", "stool"}));
        if (f.chance(0.6)) {
            f.place_along_wall(thing, anywhere);
        } else {
            f.place_freely(thing, anywhere);
        }
    }
    if (area > 8.0 && f.chance(0.15)) f.place_freely(f.make("person"), anywhere);
    // What stands about on low furniture.
    const std::vector<ItemPlan> items = f.floor().items();
    for (const ItemPlan& item : items) {
        const bool has_top =
            item.kind == "cabinet" || item.kind == "drawer_unit" || item.kind == "chest_of_drawers";
        if (!has_top || !f.chance(0.6)) continue;
        f.strew_on(item, {"books", "box", "papers", "bottle", "ball"},
                   f.count(1, 1 + static_cast<int>(3.0 * density)));
    }
}

}  // namespace

std::vector<ItemPlan> furnish_room(const RoomPlan& room, std::span<const OpeningPlan> openings,
                                   Random& random, std::span<const ItemPlan> already_there) {
    const double density = random.uniform();
    RoomFloor floor(room, openings, 0.5 - 0.35 * density);
    for (const ItemPlan& item : already_there)
        floor.place(item, {.is_checked = false});
    Furnisher furnisher(floor, random);
    add_building_parts(furnisher, room.use);
    // Where there is a kitchen, radiators go where its units leave room.
    const bool is_kitchen = room.use == "kitchen";
    if (!is_kitchen) add_to_windows(furnisher, room.use);
    furnish_by_use(furnisher, room.use, density);
    if (is_kitchen) add_to_windows(furnisher, room.use);
    add_plates(furnisher);
    add_lamps(furnisher, room.use);
    add_odds_and_ends(furnisher, room.use, density);
    std::vector<ItemPlan> items = floor.items();
    items.erase(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(already_there.size()));
    return items;
}

}  // namespace roomscribe
