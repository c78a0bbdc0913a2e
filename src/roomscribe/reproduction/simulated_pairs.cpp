// SPDX-License-Identifier: MIT
#include "roomscribe/reproduction/simulated_pairs.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/building/building.hpp"
#include "roomscribe/simulation/furnishing/furnishing.hpp"
#include "roomscribe/simulation/scanning/scanner.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe {
namespace {

constexpr double every_second_ray = 2.0;
constexpr std::uint64_t step_stream = 7;
constexpr std::uint64_t street_stream = 8;

/// A station of the plan, looking at the middle of the main room, and another a step on. The
/// station stands on free floor, and a step towards the middle leads nowhere near a wall.
void take_a_step(Scenario& scenario, double shortest, double longest) {
    Random random(scenario.seed, step_stream);
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : scenario.rooms.front().outline)
        middle += corner / static_cast<double>(scenario.rooms.front().outline.size());
    Station first = scenario.stations.front();
    const Eigen::Vector2d ahead = middle - first.at.head<2>();
    first.heading = degrees(std::atan2(ahead.y(), ahead.x()));
    Station second = first;
    const double direction = radians(first.heading + random.uniform(-20.0, 20.0));
    second.at.head<2>() += random.uniform(shortest, longest) *
                           Eigen::Vector2d(std::cos(direction), std::sin(direction));
    second.heading += random.uniform(-20.0, 20.0);
    scenario.stations = {first, second};
}

Scenario plan_pair(SceneKind kind, std::uint64_t seed) {
    Scenario scenario = plan_scene(
        kind, seed, {.scanner = ScannerKind::sick_lms200, .coarseness = every_second_ray});
    take_a_step(scenario, 0.5, 1.0);
    return scenario;
}

/// Scans from the scenario's two stations, wherever they are.
ScanPair scan_pair(const Scenario& scenario, const Context& context) {
    SimulatedWorld world;
    add_building(world, scenario);
    for (const ItemPlan& item : scenario.items)
        add_item(world, item);
    const RayCaster caster(world);
    const auto scan = [&](std::size_t i) {
        return scan_world(caster, scenario.scanner, scenario.coarseness, scenario.stations[i],
                          Random(scenario.seed, 100 + i).next(), context);
    };
    SimulatedScan target = scan(0);
    SimulatedScan source = scan(1);
    return {std::move(target.scan), std::move(source.scan),
            target.world_from_scan.inverse() * source.world_from_scan};
}

/// Bins, cases and posts about the kiosk, none where the scanner stands.
std::vector<ItemPlan> street_furniture(std::uint64_t seed) {
    constexpr int num_items = 40;
    Random random(seed, street_stream);
    std::vector<ItemPlan> items;
    for (int i = 0; i < num_items; ++i) {
        const double angle = random.uniform(0.0, radians(360.0));
        const double distance = random.uniform(12.0, 22.0) * (i % 2 == 0 ? 1.0 : 0.45);
        ItemPlan item;
        item.kind = i % 3 == 0 ? "column" : "box";
        item.at = distance * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        item.turn = random.uniform(0.0, 360.0);
        item.size = i % 3 == 0 ? Eigen::Vector3d(0.25, 0.25, random.uniform(2.0, 4.0))
                               : Eigen::Vector3d(random.uniform(0.5, 1.5), random.uniform(0.5, 2.0),
                                                 random.uniform(0.5, 1.8));
        items.push_back(item);
    }
    return items;
}

}  // namespace

ScanPair simulate_cluttered_pair(std::uint64_t seed, const Context& context) {
    return scan_pair(plan_pair(SceneKind::office, seed), context);
}

ScanPair simulate_plane_pair(std::uint64_t seed, const Context& context) {
    return scan_pair(plan_pair(SceneKind::corridor, seed), context);
}

ScanPair simulate_outdoor_pair(std::uint64_t seed, const Context& context) {
    Scenario scenario;
    scenario.seed = seed;
    scenario.storey_height = 0.0;
    scenario.rooms = {{.name = "kiosk",
                       .use = "storage",
                       .outline = {{-3.0, -2.0}, {3.0, -2.0}, {3.0, 2.0}, {-3.0, 2.0}}}};
    scenario.items = street_furniture(seed);
    scenario.scanner = ScannerKind::sick_lms200;
    scenario.coarseness = every_second_ray;
    scenario.stations = {{.at = {8.0, -6.0, 1.0}}};
    take_a_step(scenario, 0.5, 1.0);
    return scan_pair(scenario, context);
}

std::vector<ScanPair> simulate_pairs(std::size_t count, std::uint64_t seed,
                                     const Context& context) {
    constexpr std::array kinds{SceneKind::office, SceneKind::kitchen, SceneKind::room,
                               SceneKind::l_room};
    std::vector<ScanPair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        context.throw_if_cancelled();
        pairs.push_back(scan_pair(plan_pair(kinds[i % kinds.size()], seed + i), context));
    }
    return pairs;
}

ScanPair simulate_turned_pair(std::uint64_t seed, const Context& context) {
    Scenario scenario = plan_pair(SceneKind::office, seed);
    scenario.stations[1] = scenario.stations[0];
    scenario.stations[1].heading += 45.0;
    return scan_pair(scenario, context);
}

}  // namespace roomscribe
