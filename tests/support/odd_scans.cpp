// SPDX-License-Identifier: MIT
#include "support/odd_scans.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "roomscribe/geometry/bounding_box.hpp"
#include "roomscribe/simulation/scanning/scanner.hpp"
#include "roomscribe/simulation/scenario_json.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe::test {
namespace {

using Eigen::Vector3d;

/// A ray per 0.9 degrees.
constexpr double coarseness = 6.0;

std::vector<Scan> scan_from(const SimulatedWorld& world, std::span<const Station> stations) {
    const RayCaster caster(world);
    std::vector<Scan> scans;
    for (const Station& station : stations) {
        const std::uint64_t seed = scans.size() + 1;
        scans.push_back(
            scan_world(caster, ScannerKind::terrestrial, coarseness, station, seed).scan);
        scans.back().name = "scan" + std::to_string(scans.size()) + ".ply";
    }
    return scans;
}

Station station_at(double x, double y, double z, double heading) {
    return {.at = {x, y, z}, .heading = heading};
}

void add_plate(SimulatedWorld& world, Material material, const Vector3d& low,
               const Vector3d& high) {
    add_box(world, add_clutter_part(world, material), Transform::Identity(), low, high);
}

void add_tree(SimulatedWorld& world, const Vector3d& foot, double height) {
    const Vector3d crown = foot + Vector3d(0.0, 0.0, height);
    add_cylinder(world, add_clutter_part(world, Material::dark_wood), foot, crown, 0.15);
    add_ellipsoid(world, add_clutter_part(world, Material::plant),
                  Transform(Eigen::Translation3d(crown)), {1.4, 1.6, 0.4 * height});
}

Scan named(Scan scan, std::size_t i) {
    scan.name = "scan" + std::to_string(i + 1) + ".ply";
    return scan;
}

}  // namespace

Transform true_pose(std::size_t i) {
    constexpr std::array<std::array<double, 4>, 4> places{
        {{1.2, 1.0, 1.5, 0.3}, {4.2, 2.0, 1.4, 2.0}, {1.5, 2.4, 1.6, -1.1}, {5.2, 0.9, 1.3, 2.9}}};
    const auto& [x, y, z, heading] = places.at(i);
    Transform pose = Transform::Identity();
    pose.linear() = Eigen::AngleAxisd(heading, Vector3d::UnitZ()).toRotationMatrix();
    pose.rotate(Eigen::AngleAxisd(0.02 * static_cast<double>(i), Vector3d::UnitX()));
    pose.translation() = Vector3d(x, y, z);
    return pose;
}

std::vector<Scan> scan_lone_wall() {
    SimulatedWorld world;
    add_plate(world, Material::paint, {-2.0, 3.0, -1.5}, {2.0, 3.2, 1.2});
    return scan_from(world, std::array{station_at(0.0, 0.0, 0.0, 20.0)});
}

std::vector<Scan> scan_outdoors() {
    SimulatedWorld world;
    add_plate(world, Material::facade, {-30.0, -30.0, -0.5}, {30.0, 30.0, 0.0});
    add_tree(world, {6.0, 3.0, 0.0}, 3.2);
    add_tree(world, {-4.0, 8.0, 0.0}, 4.0);
    add_tree(world, {-9.0, -5.0, 0.0}, 2.8);
    const std::uint32_t bush = add_clutter_part(world, Material::plant);
    for (const Vector3d& at : {Vector3d(3.0, -4.0, 0.3), Vector3d(4.2, -4.6, 0.4)})
        add_ellipsoid(world, bush, Transform(Eigen::Translation3d(at)), {0.8, 0.9, 0.7});
    add_plate(world, Material::metal, {-6.0, 0.5, 0.3}, {-1.8, 2.2, 0.9});    // car, body
    add_plate(world, Material::metal, {-5.2, 0.65, 0.9}, {-2.6, 2.05, 1.4});  // and cabin
    for (int i = 0; i < 12; ++i) {
        const double x = -8.0 + 1.2 * i;
        add_plate(world, Material::wood, {x, -8.0, 0.0}, {x + 0.1, -7.9, 1.1});
    }
    return scan_from(world, std::array{station_at(0.0, 0.0, 1.7, 0.0)});
}

std::vector<Scan> scan_empty_room() {
    const Scenario room = scenario_from_json(R"({
      "rooms": [ { "name": "hall", "use": "storage", "ceiling_height": 2.6,
                   "outline": [[0, 0], [5, 0], [5, 4], [0, 4]] } ],
      "coarseness": 6,
      "stations": [ { "at": [1.6, 1.4, 1.5] }, { "at": [3.3, 2.7, 1.4], "heading": 75 } ] })");
    std::vector<Scan> scans = simulate_scene(room).scans;
    for (std::size_t i = 0; i < scans.size(); ++i)
        scans[i] = named(std::move(scans[i]), i);
    return scans;
}

std::vector<Scan> scan_staircase() {
    constexpr int num_steps = 14;
    constexpr double tread = 0.29;
    constexpr double rise = 0.18;
    constexpr double head = num_steps * rise;
    SimulatedWorld world;
    add_plate(world, Material::tile, {-1.5, 0.0, -0.2}, {0.0, 1.2, 0.0});
    for (int i = 0; i < num_steps; ++i) {
        add_plate(world, Material::tile, {i * tread, 0.0, i * rise},
                  {(i + 1) * tread, 1.2, (i + 1) * rise});
    }
    constexpr double end = num_steps * tread;
    add_plate(world, Material::tile, {end, 0.0, head - 0.2}, {end + 1.5, 1.2, head});
    add_plate(world, Material::paint, {-1.5, -0.2, -0.2}, {end + 1.5, 0.0, head + 2.6});
    add_plate(world, Material::paint, {-1.5, 1.2, -0.2}, {end + 1.5, 1.4, head + 2.6});
    return scan_from(world, std::array{station_at(-0.8, 0.6, 1.5, 0.0),
                                       station_at(end + 0.8, 0.5, head + 1.5, 170.0)});
}

std::vector<Scan> scan_through_glass() {
    const Scenario office = scenario_from_json(R"({
      "rooms": [ { "name": "office", "use": "office", "ceiling_height": 2.7,
                   "outline": [[0, 0], [5, 0], [5, 4], [0, 4]] },
                 { "name": "meeting", "use": "office", "ceiling_height": 2.7,
                   "outline": [[0, 4.1], [5, 4.1], [5, 7.1], [0, 7.1]] } ],
      "openings": [ { "kind": "window", "room": "office", "at": [2.5, 4], "width": 4.0,
                      "height": 2.0, "sill": 0.3, "frame_width": 0.06, "mullions": 2,
                      "transparency": 0.85 },
                    { "kind": "door", "room": "office", "at": [1.2, 0], "recess": 0.05 } ],
      "items": [ { "kind": "desk", "at": [4.4, 2], "turn": 180, "size": [0.8, 1.6, 0.73] },
                 { "kind": "table", "at": [2.5, 5.6], "size": [1.0, 2.2, 0.74] } ],
      "coarseness": 6,
      "stations": [ { "at": [1.6, 1.4, 1.5] }, { "at": [3.3, 2.7, 1.4], "heading": 75 } ] })");
    std::vector<Scan> scans = simulate_scene(office).scans;
    for (std::size_t i = 0; i < scans.size(); ++i)
        scans[i] = named(std::move(scans[i]), i);
    return scans;
}

std::vector<Scan> scan_moving_people() {
    constexpr std::array<std::array<double, 2>, 6> places{
        {{2.3, 1.8}, {5.2, 0.8}, {1.0, 3.3}, {1.2, 1.2}, {2.2, 2.4}, {4.0, 2.3}}};
    std::vector<Scan> scans;
    for (std::size_t i = 0; i < 4; ++i) {
        Scenario room = l_shaped_room();
        for (std::size_t k = 0; i % 2 == 1 && k < 3; ++k) {
            const auto& [x, y] = places.at(3 * (i / 2) + k);
            room.items.push_back({.kind = "person",
                                  .at = {x, y},
                                  .turn = 70.0 * static_cast<double>(k),
                                  .size = {0.34, 0.5, 1.75}});
        }
        scans.push_back(named(simulate_scan(room, true_pose(i), i + 1, coarseness), i));
    }
    return scans;
}

std::vector<Scan> scan_l_shaped_room(std::size_t count) {
    std::vector<Scan> scans;
    for (std::size_t i = 0; i < count; ++i) {
        scans.push_back(named(simulate_scan(l_shaped_room(), true_pose(i), i + 1, coarseness), i));
    }
    return scans;
}

std::vector<Scan> scan_two_buildings() {
    std::vector<Scan> scans = scan_l_shaped_room(2);
    for (std::size_t i = 2; i < 4; ++i) {
        Transform pose = true_pose(i);
        pose.translation() = i == 2 ? Vector3d(1.6, 1.2, 1.5) : Vector3d(2.7, 2.1, 1.4);
        scans.push_back(named(simulate_scan(other_room(), pose, i + 1, coarseness), i));
    }
    return scans;
}

Scan scan_of_object() {
    constexpr double height = 0.3;
    constexpr double step = 0.001;
    Random random(11);
    Scan scan{"vase.ply", {}};
    for (double z = 0.0; z < height; z += step) {
        // A foot, a belly, a neck.
        const double radius = 0.06 + 0.03 * std::sin(2.0 * std::numbers::pi * z / height);
        const auto count = static_cast<std::size_t>(2.0 * std::numbers::pi * radius / step);
        for (std::size_t i = 0; i < count; ++i) {
            const double angle =
                2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
            const double r = radius + 1e-4 * random.normal();
            scan.cloud.positions.emplace_back(
                Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>());
        }
    }
    return scan;
}

void mirror(Scan& scan) {
    for (Eigen::Vector3f& point : scan.cloud.positions)
        point.x() = -point.x();
    for (Eigen::Vector3f& normal : scan.cloud.normals)
        normal.x() = -normal.x();
}

void scatter_outliers(Scan& scan, double share, Random& random) {
    const Eigen::AlignedBox3f box = bounding_box(scan.cloud.positions);
    const Eigen::Vector3d center = box.center().cast<double>();
    const Eigen::Vector3d reach = 0.75 * box.sizes().cast<double>();
    for (Eigen::Vector3f& point : scan.cloud.positions) {
        if (random.uniform() >= share) continue;
        const Vector3d offset(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                              random.uniform(-1.0, 1.0));
        point = (center + offset.cwiseProduct(reach)).cast<float>();
    }
}

Scan thinned_to(const Scan& scan, std::size_t count) {
    const std::vector<std::uint32_t> finite = finite_points(scan.cloud);
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < count; ++i)
        kept.push_back(finite[i * finite.size() / count]);
    return {scan.name, select_points(scan.cloud, kept)};
}

}  // namespace roomscribe::test
