// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/simulated_scene.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/building/building.hpp"
#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/furnishing/furnishing.hpp"
#include "roomscribe/simulation/scanning/ray_caster.hpp"
#include "roomscribe/simulation/scanning/scanner.hpp"
#include "roomscribe/simulation/scanning/station_plan.hpp"
#include "roomscribe/simulation/scanning/visibility.hpp"

namespace roomscribe {
namespace {

// Streams of the scenario's seed.
constexpr std::uint64_t furnishing_stream = 2;
constexpr std::uint64_t station_stream = 3;
constexpr std::uint64_t frame_stream = 4;
constexpr std::uint64_t first_scan_stream = 100;

void check_options(const SceneOptions& options) {
    if (!(options.coarseness >= 0.5 && options.coarseness <= 20.0)) {
        throw InvalidArgument("coarseness", fmt::format("{}", options.coarseness), "0.5 to 20");
    }
    if (options.scans_per_room < 0 || options.scans_per_room > 100) {
        throw InvalidArgument("scans", fmt::format("{}", options.scans_per_room), "0 to 100");
    }
}

void check_scenario(const Scenario& scenario) {
    if (scenario.stations.empty()) {
        throw InvalidArgument("stations", "none", "at least one place to scan from");
    }
    for (const Station& station : scenario.stations) {
        const bool is_inside =
            std::any_of(scenario.rooms.begin(), scenario.rooms.end(), [&](const RoomPlan& room) {
                return room.outline.size() > 2 && contains(room.outline, station.at.head<2>()) &&
                       station.at.z() > room.floor_height && station.at.z() < room.ceiling_height;
            });
        if (!is_inside) {
            throw InvalidArgument(
                "station",
                fmt::format("at ({}, {}, {})", station.at.x(), station.at.y(), station.at.z()),
                "a place inside a room, between its floor and ceiling");
        }
    }
}

/// Of any orientation, up to 10 m off.
Transform random_world_frame(std::uint64_t seed) {
    Random random(seed, frame_stream);
    const double w = random.normal();
    const double x = random.normal();
    const double y = random.normal();
    const double z = random.normal();
    Transform map_from_building = Transform::Identity();
    map_from_building.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
    for (double& coordinate : map_from_building.translation())
        coordinate = random.uniform(-10.0, 10.0);
    return map_from_building;
}

/// Instances are indices of components here.
std::vector<std::size_t> points_of_components(std::span<const std::int32_t> instances,
                                              std::size_t num_components) {
    std::vector<std::size_t> points(num_components, 0);
    for (const std::int32_t instance : instances) {
        if (instance >= 0) ++points[static_cast<std::size_t>(instance)];
    }
    return points;
}

template <typename Value>
void append(std::vector<Value>& all, const std::vector<Value>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Scenario plan_scene(SceneKind kind, std::uint64_t seed, const SceneOptions& options) {
    check_options(options);
    Scenario scenario = plan_building(kind, seed);
    scenario.scanner = options.scanner;
    scenario.coarseness = options.coarseness;
    Random furnishing(seed, furnishing_stream);
    for (const RoomPlan& room : scenario.rooms) {
        const std::vector<ItemPlan> items = furnish_room(room, scenario.openings, furnishing);
        append(scenario.items, items);
    }
    Random stations(seed, station_stream);
    const int per_room =
        options.scans_per_room > 0 ? options.scans_per_room : usual_scans_per_room(options.scanner);
    scenario.stations =
        choose_stations(scenario, rooms_to_scan(kind, scenario), per_room, stations);
    return scenario;
}

SimulatedWorld build_world(const Scenario& scenario) {
    SimulatedWorld world;
    add_building(world, scenario);
    for (const ItemPlan& item : scenario.items)
        add_item(world, item);
    return world;
}

SimulatedScene simulate_scene(const Scenario& scenario, const Context& context) {
    check_scenario(scenario);
    SimulatedWorld world = build_world(scenario);
    const RayCaster caster(world);
    const Transform map_from_building = random_world_frame(scenario.seed);

    SimulatedScene scene;
    GroundTruth& truth = scene.truth;
    std::vector<std::optional<Transform>> poses;
    for (std::size_t i = 0; i < scenario.stations.size(); ++i) {
        context.throw_if_cancelled();
        SimulatedScan scan =
            scan_world(caster, scenario.scanner, scenario.coarseness, scenario.stations[i],
                       Random(scenario.seed, first_scan_stream + i).next(), context);
        scan.scan.name = fmt::format("{:03}.ply", i);
        append(truth.labels, scan.labels);
        append(truth.instances, scan.instances);
        append(truth.acceptable, scan.acceptable);
        poses.emplace_back(map_from_building * scan.world_from_scan);
        truth.map_from_scan.push_back(*poses.back());
        scene.scans.push_back(std::move(scan.scan));
        context.report_progress(
            "scan", static_cast<double>(i + 1) / static_cast<double>(scenario.stations.size()));
    }
    measure_visibility(
        world.scene, caster, scenario.scanner, scenario.coarseness, scenario.stations,
        points_of_components(truth.instances, world.scene.components.size()), context);
    truth.scene = transformed_scene(std::move(world.scene), map_from_building);
    truth.map = merge_scans(scene.scans, poses);
    return scene;
}

}  // namespace roomscribe
