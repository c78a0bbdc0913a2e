// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/building/building.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/simulation/building/openings.hpp"
#include "roomscribe/simulation/building/wall_layout.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// DIN 18202, table 3, line 7, well finished walls: 3 mm over 1 m, 8 mm over 4 m, so 5 mm over 2 m.
/// Half of that is the amplitude of a wave.
constexpr double wall_unevenness = 0.0025;
constexpr double unevenness_length = 2.0;
constexpr double widest_wall_cell = 0.5;

constexpr double skirting_height = 0.07;
constexpr double skirting_thickness = 0.014;

/// Ascending, ends included, no step wider than `step`.
std::vector<double> cut(double low, double high, std::vector<double> at, double step) {
    at.push_back(low);
    at.push_back(high);
    std::sort(at.begin(), at.end());
    std::vector<double> cuts{low};
    for (const double next : at) {
        if (next <= cuts.back() + 1e-9 || next > high + 1e-9) continue;
        const double from = cuts.back();
        const double pieces = std::ceil((next - from) / step);
        for (double piece = 1.0; piece <= pieces; ++piece) {
            cuts.push_back(from + (next - from) * piece / pieces);
        }
    }
    return cuts;
}

/// A wall face as a grid of cells with the holes left out, slightly uneven where it touches
/// nothing.
class WallSheet {
  public:
    WallSheet(const BuiltWallFace& face, double floor, double ceiling, std::vector<WallArea> holes,
              double phase)
        : face_(face), holes_(std::move(holes)), phase_(phase) {
        std::vector<double> at_x;
        std::vector<double> at_z;
        for (const WallArea& hole : holes_) {
            at_x.insert(at_x.end(), {hole.x_low, hole.x_high});
            at_z.insert(at_z.end(), {hole.z_low, hole.z_high});
        }
        x_ = cut(0.0, face.length(), std::move(at_x), widest_wall_cell);
        z_ = cut(floor, ceiling, std::move(at_z), widest_wall_cell);
    }

    void add_to(SimulatedWorld& world, std::uint32_t part) const {
        for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
            for (std::size_t j = 0; j + 1 < z_.size(); ++j) {
                if (is_solid(i, j)) {
                    add_quad(world, part, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1),
                             vertex(i, j + 1));
                }
            }
        }
    }

  private:
    bool is_solid(std::size_t i, std::size_t j) const {
        if (i + 1 >= x_.size() || j + 1 >= z_.size()) return false;
        const double x = (x_[i] + x_[i + 1]) / 2.0;
        const double z = (z_[j] + z_[j + 1]) / 2.0;
        return std::none_of(holes_.begin(), holes_.end(), [&](const WallArea& hole) {
            return x > hole.x_low && x < hole.x_high && z > hole.z_low && z < hole.z_high;
        });
    }

    /// The rim stays where other surfaces meet it.
    bool is_on_rim(std::size_t i, std::size_t j) const {
        return i == 0 || j == 0 || !is_solid(i - 1, j - 1) || !is_solid(i, j - 1) ||
               !is_solid(i - 1, j) || !is_solid(i, j);
    }

    Vector3d vertex(std::size_t i, std::size_t j) const {
        double relief = 0.0;
        if (!is_on_rim(i, j)) {
            const double turn = 2.0 * std::numbers::pi / unevenness_length;
            relief = wall_unevenness * std::sin(turn * x_[i] + phase_) *
                     std::cos(turn * z_[j] * 0.7 + 2.0 * phase_);
        }
        const Vector2d flat = face_.start + x_[i] * face_.along() + relief * face_.inward();
        return {flat.x(), flat.y(), z_[j]};
    }

    BuiltWallFace face_;
    std::vector<WallArea> holes_;
    double phase_;
    std::vector<double> x_;
    std::vector<double> z_;
};

std::vector<Vector3d> lifted(const std::vector<Vector2d>& outline, double z) {
    std::vector<Vector3d> corners;
    corners.reserve(outline.size());
    for (const Vector2d& corner : outline)
        corners.emplace_back(corner.x(), corner.y(), z);
    return corners;
}

/// What the building's parts are in the scene: filled room by room.
struct BuildingIndex {
    std::vector<std::int32_t> floor_of_room;
    std::vector<std::int32_t> wall_of_face;
    std::vector<std::vector<WallArea>> holes_of_face;
};

void check_outline(const RoomPlan& room) {
    if (room.outline.size() < 3 || signed_area(room.outline) <= 0.0) {
        throw InvalidArgument(fmt::format("outline of room \"{}\"", room.name),
                              fmt::format("{} corners", room.outline.size()),
                              "three corners or more, counter-clockwise");
    }
    if (room.ceiling_height <= room.floor_height) {
        throw InvalidArgument(fmt::format("ceiling_height of room \"{}\"", room.name),
                              fmt::format("{}", room.ceiling_height), "above the floor");
    }
}

std::int32_t add_surface(SimulatedWorld& world, Label label, const std::string& room,
                         std::vector<Vector3d> polygon) {
    Component component;
    component.label = label;
    component.parent = room;
    component.polygon = std::move(polygon);
    return add_component(world, std::move(component));
}

/// Floor, ceiling and the room itself.
void add_room(SimulatedWorld& world, const RoomPlan& plan, BuildingIndex& index, Random& random) {
    check_outline(plan);
    const std::vector<Vector3d> floor = lifted(plan.outline, plan.floor_height);
    const std::vector<Vector3d> ceiling = lifted(plan.outline, plan.ceiling_height);
    const std::int32_t floor_component = add_surface(world, Label::floor, plan.name, floor);
    const std::int32_t ceiling_component = add_surface(world, Label::ceiling, plan.name, ceiling);
    constexpr std::array floors{Material::wood, Material::carpet, Material::tile,
                                Material::dark_wood};
    const Material material = floors[random.below(static_cast<std::uint32_t>(floors.size()))];
    add_polygon(world, add_part(world, floor_component, material), floor);
    add_polygon(world, add_part(world, ceiling_component, Material::paint), ceiling);
    index.floor_of_room.push_back(floor_component);

    Room room;
    room.id = plan.name;
    room.polygon = floor;
    room.floor_height = plan.floor_height;
    room.ceiling_height = plan.ceiling_height;
    room.area = signed_area(plan.outline);
    room.volume = room.area * (plan.ceiling_height - plan.floor_height);
    world.scene.rooms.push_back(std::move(room));
}

void declare_walls(SimulatedWorld& world, const Scenario& scenario,
                   const std::vector<BuiltWallFace>& faces, BuildingIndex& index) {
    for (const BuiltWallFace& face : faces) {
        const RoomPlan& room = scenario.rooms[face.room];
        const auto corner = [](const Vector2d& flat, double z) {
            return Vector3d(flat.x(), flat.y(), z);
        };
        index.wall_of_face.push_back(add_surface(
            world, Label::wall, room.name,
            {corner(face.start, room.floor_height), corner(face.end, room.floor_height),
             corner(face.end, room.ceiling_height), corner(face.start, room.ceiling_height)}));
        Room& scene_room = world.scene.rooms[face.room];
        scene_room.walls.push_back(world.scene.components.back().id);
    }
    index.holes_of_face.resize(faces.size());
}

/// The hole that an opening leaves in a face that it goes through.
WallArea hole_in(const BuiltWallFace& face, const OpeningPlan& opening, const OpeningSite& site) {
    const Vector2d middle = site.world_from_site.translation().head<2>();
    const double x = (middle - face.start).dot(face.along());
    const double half_width = hole_half_width(opening);
    const double bottom = site.floor + opening.sill;
    return {x - half_width, x + half_width, bottom, bottom + hole_height(opening)};
}

void connect_rooms(Scene& scene, std::size_t a, std::size_t b, const std::string& through) {
    scene.rooms[a].neighbors.push_back({scene.rooms[b].id, through});
    scene.rooms[b].neighbors.push_back({scene.rooms[a].id, through});
}

void add_openings(SimulatedWorld& world, const Scenario& scenario,
                  const std::vector<BuiltWallFace>& faces, BuildingIndex& index) {
    for (const OpeningPlan& opening : scenario.openings) {
        const OpeningSite site =
            locate_opening(opening, scenario.rooms, faces, scenario.outer_wall_thickness);
        const std::size_t room = faces[site.face].room;
        index.holes_of_face[site.face].push_back(hole_in(faces[site.face], opening, site));
        if (site.far_face) {
            index.holes_of_face[*site.far_face].push_back(
                hole_in(faces[*site.far_face], opening, site));
        }
        const std::int32_t way = add_opening(world, opening, site, index.wall_of_face[site.face],
                                             index.floor_of_room[room]);
        if (way >= 0 && site.far_face) {
            connect_rooms(world.scene, room, faces[*site.far_face].room,
                          world.scene.components[static_cast<std::size_t>(way)].id);
        }
    }
}

/// Skirting boards run between the doorways.
void add_skirting(SimulatedWorld& world, const BuiltWallFace& face, double floor,
                  const std::vector<WallArea>& holes, std::int32_t wall) {
    const std::uint32_t part = add_part(world, wall, Material::wood, label_bit(Label::unknown));
    std::vector<double> stops{0.0};
    std::vector<WallArea> doorways;
    for (const WallArea& hole : holes) {
        if (hole.z_low <= floor + skirting_height) doorways.push_back(hole);
    }
    std::sort(doorways.begin(), doorways.end(),
              [](const WallArea& a, const WallArea& b) { return a.x_low < b.x_low; });
    for (const WallArea& doorway : doorways)
        stops.insert(stops.end(), {doorway.x_low, doorway.x_high});
    stops.push_back(face.length());
    Transform frame = Transform::Identity();
    frame.linear().col(0) << face.along(), 0.0;
    frame.linear().col(1) << face.inward(), 0.0;
    frame.translation() << face.start, floor;
    for (std::size_t i = 0; i + 1 < stops.size(); i += 2) {
        if (stops[i + 1] - stops[i] < 0.05) continue;
        // It reaches into the wall, so that no unevenness opens a slit behind it.
        add_box(world, part, frame, {stops[i], -0.01, 0.0},
                {stops[i + 1], skirting_thickness, skirting_height});
    }
}

void add_walls(SimulatedWorld& world, const Scenario& scenario,
               const std::vector<BuiltWallFace>& faces, const BuildingIndex& index,
               Random& random) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const RoomPlan& room = scenario.rooms[faces[i].room];
        const WallSheet sheet(faces[i], room.floor_height, room.ceiling_height,
                              index.holes_of_face[i], random.uniform(0.0, 2.0 * std::numbers::pi));
        sheet.add_to(world, add_part(world, index.wall_of_face[i], Material::paint));
        if (room.use != "bath") {
            add_skirting(world, faces[i], room.floor_height, index.holes_of_face[i],
                         index.wall_of_face[i]);
        }
    }
}

/// The far end of an outer face: at the building's corner, unless another room lies there.
double overhang(const Scenario& scenario, const Vector2d& corner, const Vector2d& outward) {
    const double reach = scenario.outer_wall_thickness;
    for (const RoomPlan& room : scenario.rooms) {
        if (contains(room.outline, corner + reach * outward) ||
            contains(room.outline, corner + reach / 2.0 * outward)) {
            return 0.0;
        }
    }
    return reach;
}

/// Outer faces keep rays that left through one window from coming in through the back of a wall.
void add_outer_faces(SimulatedWorld& world, const Scenario& scenario,
                     const std::vector<BuiltWallFace>& faces, const BuildingIndex& index) {
    const std::uint32_t part = add_clutter_part(world, Material::facade);
    const double thickness = scenario.outer_wall_thickness;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const BuiltWallFace& face = faces[i];
        const bool is_inner = find_far_face(faces, i, face.start + 0.02 * face.along()) ||
                              find_far_face(faces, i, (face.start + face.end) / 2.0) ||
                              find_far_face(faces, i, face.end - 0.02 * face.along());
        if (is_inner) continue;
        const RoomPlan& room = scenario.rooms[face.room];
        const Vector2d outside = -thickness * face.inward();
        const double before = overhang(scenario, face.start + outside, -face.along());
        const double after = overhang(scenario, face.end + outside, face.along());
        BuiltWallFace outer{face.room, face.start + outside - before * face.along(),
                            face.end + outside + after * face.along()};
        std::vector<WallArea> holes = index.holes_of_face[i];
        for (WallArea& hole : holes) {
            hole.x_low += before;
            hole.x_high += before;
        }
        const WallSheet sheet(outer, room.floor_height, room.ceiling_height, std::move(holes), 0.0);
        sheet.add_to(world, part);
    }
}

/// A street: ground, houses some way off, trees.
void add_outdoors(SimulatedWorld& world, const Scenario& scenario, Random& random) {
    Eigen::AlignedBox2d bounds;
    for (const RoomPlan& room : scenario.rooms)
        bounds.extend(bounds_of(room.outline));
    const Vector2d middle = bounds.center();
    const double reach = bounds.diagonal().norm() / 2.0;
    const double ground = -scenario.storey_height;
    const std::uint32_t earth = add_clutter_part(world, Material::carpet);
    const std::uint32_t houses = add_clutter_part(world, Material::facade);
    const std::uint32_t trees = add_clutter_part(world, Material::plant);
    Transform at = Transform::Identity();
    at.translation() << middle, ground;
    add_box(world, earth, at, {-90.0, -90.0, -0.5}, {90.0, 90.0, 0.0});
    for (int i = 0; i < 7; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + random.uniform(0.0, 0.5)) / 7.0;
        const double distance = reach + random.uniform(10.0, 35.0);
        const double left = random.uniform(4.0, 9.0);
        const double right = random.uniform(4.0, 9.0);
        const double height = random.uniform(6.0, 15.0);
        Transform frame = at;
        frame.rotate(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
        frame.translate(Vector3d(distance, 0.0, 0.0));
        add_box(world, houses, frame, {0.0, -left, 0.0}, {8.0, right, height});

        const double tree_distance = reach + random.uniform(4.0, 9.0);
        const double crown_height = random.uniform(2.5, 4.5);
        const double crown_width = random.uniform(1.0, 2.0);
        Transform tree = at;
        tree.rotate(Eigen::AngleAxisd(angle + 0.45, Vector3d::UnitZ()));
        tree.translate(Vector3d(tree_distance, 0.0, crown_height));
        add_ellipsoid(world, trees, tree, {crown_width, crown_width, 1.1 * crown_width});
    }
}

}  // namespace

void add_building(SimulatedWorld& world, const Scenario& scenario) {
    if (scenario.rooms.empty()) {
        throw InvalidArgument("rooms", "none", "at least one room");
    }
    Random random(scenario.seed, 1);
    const std::vector<BuiltWallFace> faces = wall_faces(scenario.rooms);
    std::set<std::string_view> names;
    for (const RoomPlan& room : scenario.rooms) {
        if (!names.insert(room.name).second) {
            throw InvalidArgument("rooms", fmt::format("two called \"{}\"", room.name),
                                  "a name of its own for each room");
        }
    }
    BuildingIndex index;
    for (const RoomPlan& room : scenario.rooms)
        add_room(world, room, index, random);
    declare_walls(world, scenario, faces, index);
    add_openings(world, scenario, faces, index);
    add_walls(world, scenario, faces, index, random);
    add_outer_faces(world, scenario, faces, index);
    add_outdoors(world, scenario, random);
}

}  // namespace roomscribe
