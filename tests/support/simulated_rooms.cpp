// SPDX-License-Identifier: MIT
#include "support/simulated_rooms.hpp"

#include <string>
#include <utility>

#include "roomscribe/simulation/building/building.hpp"
#include "roomscribe/simulation/furnishing/furnishing.hpp"
#include "roomscribe/simulation/scanning/scanner.hpp"
#include "roomscribe/simulation/scenario_json.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe::test {
namespace {

constexpr const char* l_shaped_room_text = R"({
  "rooms": [ { "name": "den", "use": "living",
               "outline": [[0, 0], [6, 0], [6, 3], [2.5, 3], [2.5, 5], [0, 5]] } ],
  "openings": [ { "kind": "door", "room": "den", "at": [4.65, 0], "recess": 0.05 },
                { "kind": "window", "room": "den", "at": [0, 1.6], "width": 1.2, "height": 1.2,
                  "sill": 0.9, "recess": 0.1 } ],
  "items": [ { "kind": "table", "at": [3.1, 0.9], "turn": 90, "size": [0.8, 1.4, 0.75], "style": 1 },
             { "kind": "wardrobe", "at": [5.69, 2.2], "turn": 180, "size": [0.6, 1.4, 2.1] },
             { "kind": "cabinet", "at": [0.7, 4.8], "turn": -90, "size": [0.35, 1.2, 1.1] },
             { "kind": "bed", "at": [1.95, 4.3], "turn": 180, "size": [1.0, 1.0, 0.6] },
             { "kind": "box", "at": [0.3, 0.5], "turn": 20, "size": [0.4, 0.5, 0.9] },
             { "kind": "shelf", "at": [3.3, 2.83], "turn": -90, "size": [0.3, 0.8, 1.8], "style": 3 },
             { "kind": "chair", "at": [3.2, 1.8], "turn": -80 } ]
})";

constexpr const char* other_room_text = R"({
  "rooms": [ { "name": "cell", "use": "storage", "ceiling_height": 2.9,
               "outline": [[0, 0], [4.1, 0], [4.1, 3.2], [0, 3.2]] } ],
  "openings": [ { "kind": "door", "room": "cell", "at": [2.9, 3.2], "width": 1.0, "height": 2.1,
                  "recess": 0.12 } ],
  "items": [ { "kind": "wardrobe", "at": [0.31, 1.0], "turn": 0, "size": [0.6, 1.9, 2.4], "style": 5 },
             { "kind": "drawer_unit", "at": [3.79, 0.6], "turn": 180, "size": [0.6, 1.1, 0.8] },
             { "kind": "column", "at": [3.9, 2.4], "size": [0.3, 0.3, 2.9] },
             { "kind": "box", "at": [0.9, 2.85], "size": [0.6, 0.7, 0.35] } ]
})";

constexpr const char* furnished_room_text = R"({
  "rooms": [ { "name": "office", "use": "office", "ceiling_height": 2.7,
               "outline": [[0, 0], [5, 0], [5, 4], [0, 4]] } ],
  "openings": [ { "kind": "door", "room": "office", "at": [4.2, 0], "width": 0.86, "recess": 0 },
                { "kind": "window", "room": "office", "at": [2.2, 4], "width": 1.2, "height": 1.1,
                  "sill": 0.9, "frame_width": 0.07, "recess": 0.1, "blind": 1 } ],
  "items": [ { "kind": "desk", "at": [2.2, 3.5], "turn": -90, "size": [0.8, 1.6, 0.74], "style": 2 },
             { "kind": "office_chair", "at": [2.3, 2.7], "turn": 80, "style": 1 },
             { "kind": "cabinet", "at": [0.23, 1.2], "turn": 0, "size": [0.4, 1.2, 1.1], "style": 4 },
             { "kind": "box", "at": [4.5, 3.5], "turn": 30, "size": [0.4, 0.4, 0.4] } ],
  "coarseness": 6,
  "stations": [ { "at": [1.3, 1.7, 1.5] }, { "at": [3.6, 1.5, 1.4], "heading": 70 },
                { "at": [3.6, 2.9, 1.6], "heading": 200 } ]
})";

Scenario furnished_room(std::uint64_t seed, double coarseness) {
    Scenario scenario = scenario_from_json(furnished_room_text);
    scenario.seed = seed;
    scenario.coarseness = coarseness;
    return scenario;
}

}  // namespace

Scenario l_shaped_room() {
    return scenario_from_json(l_shaped_room_text);
}

Scenario other_room() {
    return scenario_from_json(other_room_text);
}

Scan simulate_scan(const Scenario& room, const Transform& room_from_scan, std::uint64_t seed,
                   double coarseness) {
    SimulatedWorld world;
    add_building(world, room);
    for (const ItemPlan& item : room.items)
        add_item(world, item);
    Station station;
    station.at = room_from_scan.translation();
    SimulatedScan upright =
        scan_world(RayCaster(world), ScannerKind::terrestrial, coarseness, station, seed);
    transform_in_place(upright.scan.cloud, room_from_scan.inverse() * upright.world_from_scan);
    return std::move(upright.scan);
}

LabelledCloud simulate_furnished_room(std::uint64_t seed, double coarseness) {
    const SimulatedScene scene = simulate_scene(furnished_room(seed, coarseness));
    LabelledCloud result;
    result.cloud.positions = scene.truth.map.cloud.positions;
    transform_in_place(result.cloud, scene.truth.scene.room_from_map);
    result.labels = scene.truth.labels;
    return result;
}

std::vector<Scan> scan_furnished_room(std::uint64_t seed, double coarseness) {
    std::vector<Scan> scans = simulate_scene(furnished_room(seed, coarseness)).scans;
    for (std::size_t i = 0; i < scans.size(); ++i)
        scans[i].name = "scan" + std::to_string(i + 1) + ".ply";
    return scans;
}

}  // namespace roomscribe::test
