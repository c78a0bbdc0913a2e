// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/building/building_plan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/simulation/building/wall_layout.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

bool happens(Random& random, double probability) {
    return random.uniform() < probability;
}

template <typename Value, std::size_t Size>
const Value& pick(const std::array<Value, Size>& choices, Random& random) {
    return choices[random.below(static_cast<std::uint32_t>(Size))];
}

// --- doors and windows

OpeningPlan made_up_door(Random& random, double chance_of_open) {
    OpeningPlan door;
    door.kind = OpeningKind::door;
    // Leaves come in steps of 5 cm, a little more or less by the maker.
    const double nominal_width = std::round(random.uniform(0.7, 1.1) / 0.05) * 0.05;
    door.width = nominal_width + random.uniform(-0.01, 0.01);
    door.height = random.uniform(1.95, 2.15);
    door.frame_width = random.uniform(0.04, 0.09);
    door.frame_protrusion = happens(random, 0.3) ? 0.0 : random.uniform(0.005, 0.03);
    door.recess = happens(random, 0.4) ? random.uniform(0.0, 0.01) : random.uniform(0.01, 0.12);
    // Doors open into rooms, not into the way of people in the corridor.
    door.opens_into_room = happens(random, 0.93);
    door.is_hinged_left = happens(random, 0.5);
    door.is_glazed = happens(random, 0.12);
    door.is_double = happens(random, 0.08);
    if (door.is_double) door.width *= 1.7;
    door.transparency = random.uniform(0.8, 0.95);
    door.style = random.next() % 1000;
    const double lot = random.uniform();
    if (lot < chance_of_open) {
        door.leaf = LeafState::open;
        door.leaf_angle = random.uniform(70.0, 110.0);
        // A leaf deep in the reveal strikes the lining beyond a right angle.
        if (door.recess > 0.02) door.leaf_angle = std::min(door.leaf_angle, 88.0);
    } else if (lot < chance_of_open + 0.15) {
        door.leaf = LeafState::ajar;
        door.leaf_angle = random.uniform(4.0, 40.0);
    }
    return door;
}

OpeningPlan made_up_window(Random& random, double ceiling) {
    OpeningPlan window;
    window.kind = OpeningKind::window;
    // Narrow ones are rare.
    window.width = happens(random, 0.15) ? random.uniform(0.5, 0.8) : random.uniform(0.8, 2.4);
    const bool is_french = happens(random, 0.1);
    window.sill = is_french ? random.uniform(0.0, 0.1) : random.uniform(0.75, 1.1);
    const double room_above = ceiling - window.sill - 0.15;
    window.height =
        is_french ? std::min(2.15, room_above) : std::min(random.uniform(0.6, 1.6), room_above);
    window.frame_width = random.uniform(0.05, std::min(0.11, 0.1 + 0.02 * (window.width - 0.5)));
    window.frame_protrusion = 0.0;
    window.recess = random.uniform(0.05, 0.2);
    // One sash is rarely wider than 1.3 m.
    window.mullions = static_cast<int>(std::floor(window.width / random.uniform(0.7, 1.3)));
    window.blind = happens(random, 0.2) ? random.uniform(0.1, 0.9) : 0.0;
    window.transparency = random.uniform(0.75, 0.95);
    window.style = random.next() % 1000;
    return window;
}

/// True if nothing else of that wall, on either side of it, is in the way.
bool is_free(const Scenario& scenario, const BuiltWallFace& face, double along, double half_width) {
    constexpr double pier = 0.15;
    return std::none_of(scenario.openings.begin(), scenario.openings.end(),
                        [&](const OpeningPlan& other) {
                            const Vector2d offset = other.at - face.start;
                            return std::abs(offset.dot(face.inward())) < 0.6 &&
                                   std::abs(offset.dot(face.along()) - along) <
                                       half_width + hole_half_width(other) + pier;
                        });
}

/// Height of the lower of the ceilings on both sides of a wall.
double headroom(const Scenario& scenario, std::span<const BuiltWallFace> faces, std::size_t face,
                const Vector2d& at) {
    double height = scenario.rooms[faces[face].room].ceiling_height;
    if (const std::optional<FarFace> far = find_far_face(faces, face, at)) {
        height = std::min(height, scenario.rooms[faces[far->face].room].ceiling_height);
    }
    return height;
}

/// Sets the opening somewhere into a face between `low` and `high` of its length; false if there is
/// no room for it.
bool set_into_face(Scenario& scenario, std::span<const BuiltWallFace> faces, std::size_t face,
                   OpeningPlan opening, Random& random, bool needs_outdoors) {
    constexpr double corner_distance = 0.12;
    const BuiltWallFace& wall = faces[face];
    const double half = hole_half_width(opening);
    const double low = half + corner_distance;
    const double high = wall.length() - half - corner_distance;
    if (high <= low) return false;
    for (int attempt = 0; attempt < 12; ++attempt) {
        const double along = random.uniform(low, high);
        const Vector2d at = wall.start + along * wall.along();
        const auto has_room_behind = [&](double offset) {
            return find_far_face(faces, face, at + offset * wall.along()).has_value();
        };
        const std::array behind{has_room_behind(-half), has_room_behind(0.0),
                                has_room_behind(half)};
        const auto num_behind = std::count(behind.begin(), behind.end(), true);
        if (num_behind != (needs_outdoors ? 0 : 3)) continue;
        if (!is_free(scenario, wall, along, half)) continue;
        opening.height = std::min(opening.height, headroom(scenario, faces, face, at) -
                                                      opening.sill - opening.frame_width - 0.05);
        opening.room = scenario.rooms[wall.room].name;
        opening.at = at;
        if (!needs_outdoors) {
            // The far wall is no thicker than this face's own: the recess stays within it.
            const double thickness = find_far_face(faces, face, at)->thickness;
            opening.recess = std::min(opening.recess, std::max(0.0, thickness - 0.05));
        }
        scenario.openings.push_back(std::move(opening));
        return true;
    }
    return false;
}

/// Windows of one kind, on one or two walls of a room as a rule, until about a sixth of its floor
/// is glass (building codes ask for an eighth or a tenth).
void add_windows(Scenario& scenario, std::size_t room, Random& random) {
    const std::vector<BuiltWallFace> faces = wall_faces(scenario.rooms);
    const RoomPlan& plan = scenario.rooms[room];
    const OpeningPlan type = made_up_window(random, plan.ceiling_height);
    const bool is_minor = plan.use == "bath" || plan.use == "storage";
    const double lot = random.uniform();
    int num_walls = lot < 0.65 ? 1 : lot < 0.93 ? 2 : 3;
    double wanted = signed_area(plan.outline) * random.uniform(0.1, 0.22);
    std::vector<std::size_t> outer;
    for (std::size_t face = 0; face < faces.size(); ++face) {
        if (faces[face].room == room) outer.push_back(face);
    }
    std::rotate(outer.begin(),
                outer.begin() + random.below(static_cast<std::uint32_t>(outer.size())),
                outer.end());
    for (const std::size_t face : outer) {
        bool is_used = false;
        for (int i = 0; i < 6 && num_walls > 0 && wanted > 0.0; ++i) {
            OpeningPlan window = type;
            window.blind = happens(random, 0.5) ? type.blind : 0.0;
            if (!set_into_face(scenario, faces, face, window, random, true)) break;
            is_used = true;
            wanted = is_minor ? 0.0 : wanted - window.width * window.height;
        }
        if (is_used) --num_walls;
    }
}

void add_niche(Scenario& scenario, std::size_t room, Random& random) {
    const std::vector<BuiltWallFace> faces = wall_faces(scenario.rooms);
    OpeningPlan niche;
    niche.kind = OpeningKind::niche;
    niche.width = random.uniform(0.4, 1.0);
    niche.height = random.uniform(0.5, 1.4);
    niche.sill = random.uniform(0.4, 1.0);
    niche.recess = random.uniform(0.1, 0.25);
    for (std::size_t face = 0; face < faces.size(); ++face) {
        if (faces[face].room == room && set_into_face(scenario, faces, face, niche, random, true)) {
            return;
        }
    }
}

/// A door, or now and then a passage, from a room to the room behind one of its faces.
void add_way(Scenario& scenario, std::size_t room, std::size_t to, double chance_of_open,
             double chance_of_passage, Random& random) {
    const std::vector<BuiltWallFace> faces = wall_faces(scenario.rooms);
    OpeningPlan way = made_up_door(random, chance_of_open);
    if (happens(random, chance_of_passage)) {
        way.kind = OpeningKind::passage;
        way.leaf = LeafState::open;
        way.is_double = way.is_glazed = false;
        way.width = random.uniform(0.8, 1.8);
        if (happens(random, 0.5)) way.frame_width = 0.0;
    }
    for (std::size_t face = 0; face < faces.size(); ++face) {
        if (faces[face].room != room) continue;
        const Vector2d middle = (faces[face].start + faces[face].end) / 2.0;
        const std::optional<FarFace> far = find_far_face(faces, face, middle);
        if (!far || faces[far->face].room != to) continue;
        for (int attempt = 0; attempt < 3; ++attempt) {
            if (set_into_face(scenario, faces, face, way, random, false)) return;
            way.is_double = false;
            way.width = 0.7;
        }
    }
}

// --- rooms

RoomPlan make_room(std::string name, std::string use, std::vector<Vector2d> outline,
                   double ceiling) {
    return {.name = std::move(name),
            .use = std::move(use),
            .outline = std::move(outline),
            .floor_height = 0.0,
            .ceiling_height = ceiling};
}

std::vector<Vector2d> rectangle(double x_low, double y_low, double x_high, double y_high) {
    return {{x_low, y_low}, {x_high, y_low}, {x_high, y_high}, {x_low, y_high}};
}

double inner_wall_thickness(Random& random) {
    constexpr std::array thicknesses{0.1, 0.115, 0.15, 0.175, 0.24};
    return pick(thicknesses, random);
}

/// Rooms side by side along a hall. `near` and `far` are the y of their walls at the hall and away
/// from it; `widths` are shares of the length.
struct Row {
    double x_low = 0.0;
    double x_high = 0.0;
    double near = 0.0;
    double far = 0.0;
    std::vector<double> widths;
    double chance_of_slant = 0.0;
};

std::vector<std::vector<Vector2d>> outlines_of(const Row& row, Random& random) {
    double total = 0.0;
    for (const double width : row.widths)
        total += width;
    const double depth = std::abs(row.far - row.near);
    std::vector<std::vector<Vector2d>> outlines;
    double left_near = row.x_low;
    double left_far = row.x_low;
    double done = 0.0;
    for (std::size_t i = 0; i < row.widths.size(); ++i) {
        done += row.widths[i];
        const bool is_last = i + 1 == row.widths.size();
        const double cut = row.x_low + (row.x_high - row.x_low) * done / total;
        const double lean = is_last || !happens(random, row.chance_of_slant)
                                ? 0.0
                                : depth * std::tan(radians(random.uniform(6.0, 14.0)));
        const double half = is_last ? 0.0 : inner_wall_thickness(random) / 2.0;
        const double right_near = cut - lean / 2.0 - half;
        const double right_far = cut + lean / 2.0 - half;
        std::vector<Vector2d> outline{{left_near, row.near},
                                      {right_near, row.near},
                                      {right_far, row.far},
                                      {left_far, row.far}};
        if (row.far < row.near) std::reverse(outline.begin(), outline.end());
        outlines.push_back(std::move(outline));
        left_near = right_near + 2.0 * half;
        left_far = right_far + 2.0 * half;
    }
    return outlines;
}

/// A hall (rooms[0]) with a row of rooms on one or both sides.
struct HallPlan {
    double length = 10.0;
    double width = 1.5;
    double ceiling = 2.6;
    double hall_ceiling = 2.6;
    double chance_of_open = 0.5;
    double chance_of_passage = 0.0;
    double chance_of_slant = 0.1;
    std::string hall_use = "corridor";
    std::vector<std::string> uses_above;
    std::vector<std::string> uses_below;
    double depth_above = 4.0;
    double depth_below = 4.0;
};

void add_row(Scenario& scenario, const HallPlan& plan, bool is_above, Random& random) {
    const std::vector<std::string>& uses = is_above ? plan.uses_above : plan.uses_below;
    if (uses.empty()) return;
    const double wall = inner_wall_thickness(random);
    Row row{.x_low = 0.0,
            .x_high = plan.length,
            .near = is_above ? plan.width + wall : -wall,
            .far = is_above ? plan.width + wall + plan.depth_above : -wall - plan.depth_below,
            .widths = {},
            .chance_of_slant = plan.chance_of_slant};
    for (const std::string& use : uses) {
        row.widths.push_back(use == "bath" || use == "storage" ? random.uniform(0.55, 0.7)
                                                               : random.uniform(0.9, 1.4));
    }
    const std::vector<std::vector<Vector2d>> outlines = outlines_of(row, random);
    for (std::size_t i = 0; i < uses.size(); ++i) {
        scenario.rooms.push_back(make_room(fmt::format("{}-{}", uses[i], scenario.rooms.size()),
                                           uses[i], outlines[i], plan.ceiling));
    }
}

void lay_out_hall(Scenario& scenario, const HallPlan& plan, Random& random) {
    scenario.rooms.push_back(make_room(plan.hall_use + "-0", plan.hall_use,
                                       rectangle(0.0, 0.0, plan.length, plan.width),
                                       plan.hall_ceiling));
    add_row(scenario, plan, true, random);
    add_row(scenario, plan, false, random);
    for (std::size_t room = 1; room < scenario.rooms.size(); ++room) {
        const bool is_private = scenario.rooms[room].use == "bath";
        add_way(scenario, room, 0, plan.chance_of_open, is_private ? 0.0 : plan.chance_of_passage,
                random);
    }
    for (std::size_t room = 0; room < scenario.rooms.size(); ++room)
        add_windows(scenario, room, random);
}

/// The main room (rooms[0]) above a hall (rooms[1]) that its door leads to.
void lay_out_room(Scenario& scenario, std::string use, std::vector<Vector2d> outline,
                  double ceiling, Random& random) {
    const double wall = inner_wall_thickness(random);
    const double right = outline[1].x();
    const double hall_width = random.uniform(1.4, 2.4);
    const std::string name = use + "-0";
    scenario.rooms.push_back(make_room(name, std::move(use), std::move(outline), ceiling));
    scenario.rooms.push_back(make_room(
        "hall-1", "hall", rectangle(-1.5, -wall - hall_width, right + 1.5, -wall), ceiling));
    add_way(scenario, 0, 1, 0.35, 0.08, random);
    if (happens(random, 0.35)) add_way(scenario, 0, 1, 0.2, 0.0, random);
    add_windows(scenario, 0, random);
    if (happens(random, 0.25)) add_niche(scenario, 0, random);
}

std::vector<Vector2d> l_shape(double width, double depth, Random& random) {
    const double x = width * random.uniform(0.45, 0.65);
    const double y = depth * random.uniform(0.45, 0.65);
    if (happens(random, 0.5)) {
        return {{0.0, 0.0}, {width, 0.0}, {width, y}, {x, y}, {x, depth}, {0.0, depth}};
    }
    return {{0.0, 0.0}, {width, 0.0}, {width, depth}, {x, depth}, {x, y}, {0.0, y}};
}

std::vector<Vector2d> slanted_shape(double width, double depth, Random& random) {
    const double lean = depth * std::tan(radians(random.uniform(8.0, 25.0)));
    if (happens(random, 0.5)) {
        return {{0.0, 0.0}, {width, 0.0}, {width - lean, depth}, {0.0, depth}};
    }
    // A corner cut off.
    const double cut = std::min(width, depth) * random.uniform(0.3, 0.45);
    return {{0.0, 0.0}, {width, 0.0}, {width, depth - cut}, {width - cut, depth}, {0.0, depth}};
}

HallPlan corridor_plan(Random& random) {
    HallPlan plan;
    plan.length = random.uniform(8.0, 16.0);
    plan.width = random.uniform(1.5, 2.4);
    plan.ceiling = random.uniform(2.6, 3.1);
    plan.hall_ceiling = plan.ceiling - (happens(random, 0.5) ? random.uniform(0.2, 0.4) : 0.0);
    plan.chance_of_open = 0.25;
    const auto num_rooms = static_cast<std::size_t>(plan.length / random.uniform(2.8, 4.0));
    plan.uses_above.assign(num_rooms, "office");
    if (happens(random, 0.7))
        plan.uses_below.assign(std::max<std::size_t>(1, num_rooms - 1), "office");
    plan.depth_above = plan.depth_below = random.uniform(3.5, 4.5);
    return plan;
}

HallPlan flat_plan(Random& random) {
    HallPlan plan;
    plan.ceiling = random.uniform(2.4, 2.9);
    plan.hall_ceiling = plan.ceiling - (happens(random, 0.2) ? 0.25 : 0.0);
    plan.hall_use = "hall";
    plan.width = random.uniform(1.2, 1.7);
    plan.chance_of_open = 0.75;
    plan.chance_of_passage = 0.15;
    plan.chance_of_slant = 0.15;
    const std::uint32_t num_rooms = 2 + random.below(4);
    plan.uses_above = {"living", "kitchen"};
    if (num_rooms >= 3) plan.uses_below = {"bedroom"};
    if (num_rooms >= 4) plan.uses_below.emplace_back("bath");
    if (num_rooms >= 5) plan.uses_above.emplace_back("bedroom");
    plan.length = 3.6 * static_cast<double>(plan.uses_above.size()) * random.uniform(0.9, 1.1);
    plan.depth_above = random.uniform(3.6, 5.0);
    plan.depth_below = random.uniform(3.0, 4.0);
    return plan;
}

HallPlan floor_plan(Random& random) {
    HallPlan plan;
    plan.ceiling = random.uniform(2.7, 3.1);
    plan.hall_ceiling = plan.ceiling - (happens(random, 0.6) ? random.uniform(0.2, 0.4) : 0.0);
    plan.width = random.uniform(1.8, 2.4);
    plan.chance_of_open = 0.6;
    plan.chance_of_passage = 0.05;
    const std::uint32_t num_above = 6 + random.below(3);
    const std::uint32_t num_below = 6 + random.below(2);
    constexpr std::array uses{"office",  "office",  "office", "meeting",
                              "storage", "kitchen", "bath"};
    for (std::uint32_t i = 0; i < num_above; ++i)
        plan.uses_above.emplace_back(pick(uses, random));
    for (std::uint32_t i = 0; i < num_below; ++i)
        plan.uses_below.emplace_back(pick(uses, random));
    plan.length = 3.6 * static_cast<double>(num_above);
    plan.depth_above = random.uniform(4.0, 6.0);
    plan.depth_below = random.uniform(3.5, 5.5);
    return plan;
}

bool has_passable_way(const Scenario& scenario, std::size_t room,
                      std::span<const BuiltWallFace> faces) {
    return std::any_of(
        scenario.openings.begin(), scenario.openings.end(), [&](const OpeningPlan& opening) {
            const bool is_way =
                opening.kind == OpeningKind::passage ||
                (opening.kind == OpeningKind::door && opening.leaf == LeafState::open);
            if (!is_way) return false;
            const OpeningSite site =
                locate_opening(opening, scenario.rooms, faces, scenario.outer_wall_thickness);
            return faces[site.face].room == room ||
                   (site.far_face && faces[*site.far_face].room == room);
        });
}

}  // namespace

Scenario plan_building(SceneKind kind, std::uint64_t seed) {
    Random random(seed, 1000 + static_cast<std::uint64_t>(kind));
    Scenario scenario;
    scenario.name = fmt::format("{}-{}", scene_kind_names[static_cast<std::size_t>(kind)], seed);
    scenario.seed = seed;
    scenario.outer_wall_thickness = random.uniform(0.25, 0.45);
    scenario.storey_height = happens(random, 0.3) ? 0.2 : random.uniform(2.8, 12.0);
    const double ceiling = random.uniform(2.4, 3.2);
    const double width = random.uniform(3.0, 7.0);
    const double depth = random.uniform(3.0, 6.0);
    constexpr std::array uses{"office", "living", "bedroom", "meeting", "storage"};
    const char* use = pick(uses, random);
    switch (kind) {
        case SceneKind::room:
            lay_out_room(scenario, use, rectangle(0.0, 0.0, width, depth), ceiling, random);
            break;
        case SceneKind::l_room:
            lay_out_room(scenario, use, l_shape(width + 2.0, depth + 2.0, random), ceiling, random);
            break;
        case SceneKind::slanted:
            lay_out_room(scenario, use, slanted_shape(width + 1.5, depth, random), ceiling, random);
            break;
        case SceneKind::office:
            lay_out_room(scenario, "office", rectangle(0.0, 0.0, width + 2.0, depth + 0.5), ceiling,
                         random);
            break;
        case SceneKind::kitchen:
            lay_out_room(scenario, "kitchen",
                         rectangle(0.0, 0.0, std::min(width, 5.0), std::min(depth, 5.0)), ceiling,
                         random);
            break;
        case SceneKind::corridor:
            lay_out_hall(scenario, corridor_plan(random), random);
            break;
        case SceneKind::flat:
            lay_out_hall(scenario, flat_plan(random), random);
            break;
        case SceneKind::floor:
            lay_out_hall(scenario, floor_plan(random), random);
            break;
    }
    return scenario;
}

std::vector<std::size_t> rooms_to_scan(SceneKind kind, const Scenario& scenario) {
    std::vector<std::size_t> rooms{0};
    if (kind != SceneKind::flat && kind != SceneKind::floor) return rooms;
    const std::vector<BuiltWallFace> faces = wall_faces(scenario.rooms);
    for (std::size_t room = 1; room < scenario.rooms.size(); ++room) {
        if (has_passable_way(scenario, room, faces)) rooms.push_back(room);
    }
    return rooms;
}

}  // namespace roomscribe
